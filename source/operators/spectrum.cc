// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/operators/spectrum.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <vector>

namespace PeriDeal
{
  namespace
  {
    /** x <- C^{-1/2} x or C^{1/2} x. */
    void scale(Vector &x, const Vector &capacity, const bool inverse)
    {
      for (unsigned int i = 0; i < x.locally_owned_size(); ++i)
        {
          const double root = std::sqrt(capacity.local_element(i));
          x.local_element(i) *= inverse ? 1. / root : root;
        }
    }


    double lanczos(const Operator &op, Vector &start)
    {
      constexpr unsigned int n_max    = 60;
      const Vector          &capacity = op.lumped_capacity();
      std::vector<Vector>    basis;
      std::vector<double>    alpha, beta;
      Vector                 x(start), y(start);
      scale(start, capacity, false);
      start /= start.l2_norm();
      basis.push_back(start);
      double bound = 0.;
      for (unsigned int k = 0; k < n_max; ++k)
        {
          x = basis.back();
          scale(x, capacity, true);
          op.apply(y, x);
          scale(y, capacity, true);
          alpha.push_back(basis.back() * y);
          for (unsigned int pass = 0; pass < 2; ++pass)
            for (const Vector &v : basis)
              y.add(-(v * y), v);
          const double          norm     = y.l2_norm();
          const Eigen::VectorXd diagonal = Eigen::Map<Eigen::VectorXd>(alpha.data(), alpha.size());
          const Eigen::VectorXd side     = Eigen::Map<Eigen::VectorXd>(beta.data(), beta.size());
          Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> ritz;
          ritz.computeFromTridiagonal(diagonal, side);
          const Eigen::Index last     = diagonal.size() - 1;
          const double       residual = norm * std::abs(ritz.eigenvectors()(last, last));
          bound                       = ritz.eigenvalues()[last] + residual;
          if (residual < 5e-3 * bound || norm <= 1e-12 * bound)
            break;
          beta.push_back(norm);
          y /= norm;
          basis.push_back(y);
        }
      return bound;
    }


    double power_iterations(const Operator &op, Vector &x)
    {
      constexpr unsigned int n_steps = 80;
      constexpr double       margin  = 1.05; // the iteration comes from below
      Vector                 y(x);
      double                 largest = 0.;
      for (unsigned int k = 0; k < n_steps; ++k)
        {
          x /= x.l2_norm();
          op.apply(y, x);
          for (unsigned int i = 0; i < y.locally_owned_size(); ++i)
            y.local_element(i) /= op.lumped_capacity().local_element(i);
          largest = y.l2_norm();
          x.swap(y);
          op.distribute_homogeneous(x);
        }
      return margin * largest;
    }
  } // namespace


  double round_up(const double x)
  {
    if (!(x > 0.))
      return 0.;
    const double unit = std::pow(10., std::floor(std::log10(x)) - 2.);
    return std::ceil(x / unit * (1. - 1e-9)) * unit;
  }


  double sharp_bound(const Operator                            &op,
                     const double                               gershgorin,
                     const std::function<void(Vector &vector)> &fill)
  {
    Vector start;
    op.initialize_vector(start);
    fill(start);
    op.distribute_homogeneous(start);
    const double bound = op.symmetric() ? lanczos(op, start) : power_iterations(op, start);
    return std::min(round_up(bound), gershgorin);
  }
} // namespace PeriDeal
