// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/operators/bounds/spectrum.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "ritz_bound.h"

namespace PeriDeal
{
  namespace
  {
    /**
     * Largest eigenvalue by Lanczos iterations with the last two vectors only: once an eigenvalue
     * has converged copies of it appear, but the largest one is as good as with all vectors kept,
     * which would take more memory than all else.
     */
    double lanczos(const Operator &op, Vector &now, const double enough, const Vector &metric)
    {
      Vector inverse_root(metric), last(now), x(now), y(now);
      for (double &c : inverse_root)
        c = 1. / std::sqrt(c);
      for (unsigned int i = 0; i < now.locally_owned_size(); ++i)
        now.local_element(i) /= inverse_root.local_element(i);
      now /= now.l2_norm();
      last           = 0.;
      double    norm = 0.;
      RitzBound bound(enough);
      for (unsigned int k = 0; k < RitzBound::n_max; ++k)
        {
          x = now;
          x.scale(inverse_root);
          op.apply_then(y, x, [&](const unsigned int begin, const unsigned int end) {
            for (unsigned int i = begin; i < end; ++i)
              y.local_element(i) =
                inverse_root.local_element(i) * y.local_element(i) - norm * last.local_element(i);
          });
          const double alpha = now * y;
          y.add(-alpha, now);
          norm = y.l2_norm();
          if (bound.take(alpha, norm))
            break;
          y /= norm;
          last.swap(now);
          now.swap(y);
        }
      return bound.value();
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


  SpectralBounds::SpectralBounds(const Operator                      &op,
                                 const std::function<void(Vector &)> &fill_noise)
    : op(op)
    , fill_noise(fill_noise)
  {}


  void SpectralBounds::set(const double gershgorin)
  {
    bounds = {gershgorin, 0.};
  }


  double SpectralBounds::safe() const
  {
    return bounds.safe;
  }


  Spectrum SpectralBounds::get() const
  {
    if (bounds.sharp == 0.)
      bounds.sharp = sharp_bound(op, bounds.safe, fill_noise);
    return bounds;
  }


  const Vector &SpectralBounds::noise() const
  {
    if (kept_noise.size() == 0)
      {
        op.initialize_vector(kept_noise);
        fill_noise(kept_noise);
      }
    return kept_noise;
  }


  void SpectralBounds::raise(const double                               gershgorin,
                             const std::vector<unsigned int>           &rows,
                             const std::function<double(const double)> &local_bound)
  {
    bounds.safe = std::max(bounds.safe, gershgorin);
    if (bounds.sharp == 0.) // nobody has asked yet
      return;
    double        sharp = local_bound(bounds.sharp);
    const Vector &start = noise();
    if (sharp >= 0.)
      sharp = std::min(round_up(sharp), bounds.safe);
    else
      sharp = sharp_bound(
        op,
        bounds.safe,
        [&](Vector &vector) {
          for (const unsigned int i : rows)
            vector.local_element(i) = start.local_element(i);
        },
        bounds.sharp);
    bounds.sharp = std::max(bounds.sharp, sharp);
  }


  double lowest_eigenvalue(const dealii::FullMatrix<double> &matrix)
  {
    Eigen::MatrixXd copy(matrix.m(), matrix.n());
    for (unsigned int i = 0; i < matrix.m(); ++i)
      for (unsigned int j = 0; j < matrix.n(); ++j)
        copy(i, j) = matrix(i, j);
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(copy, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .minCoeff();
  }


  double round_up(const double x)
  {
    if (!(x > 0.))
      return 0.;
    const double unit = std::pow(10., std::floor(std::log10(x)) - 2.);
    return std::ceil(x / unit * (1. - 1e-9)) * unit;
  }


  double sharp_bound(const Operator                            &op,
                     const double                               gershgorin,
                     const std::function<void(Vector &vector)> &fill,
                     const double                               enough,
                     const Vector                              *metric)
  {
    Vector start;
    op.initialize_vector(start);
    fill(start);
    op.distribute_homogeneous(start);
    if (start.l2_norm() == 0.)
      return 0.;
    const double bound =
      op.symmetric() ?
        lanczos(op, start, enough, metric == nullptr ? op.lumped_capacity() : *metric) :
        power_iterations(op, start);
    return std::min(round_up(bound), gershgorin);
  }
} // namespace PeriDeal
