// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/analysis/half_power_fit.h>

#include <Eigen/QR>
#include <cmath>

namespace PeriDeal
{
  HalfPowerFit::HalfPowerFit(const int lowest, const int highest, const double scale)
    : lowest(lowest)
    , highest(highest)
    , scale(scale)
  {
    const std::size_t n = terms_at(scale, 0.).size();
    matrix.assign(n * n, 0.);
    right_side.assign(n, 0.);
    coefficients.assign(n, 0.);
  }


  /** Calls visit(n, whether it is a sine); r^2 comes after these. */
  template <typename Visit>
  void HalfPowerFit::for_each_term(const Visit &visit) const
  {
    for (int n = lowest; n <= highest; ++n)
      {
        visit(n, false);
        if (n != 0)
          visit(n, true);
      }
  }


  std::vector<double> HalfPowerFit::terms_at(const double r, const double angle) const
  {
    const double        x = r / scale;
    std::vector<double> terms;
    for_each_term([&](const int n, const bool sine) {
      terms.push_back(std::pow(x, 0.5 * n) *
                      (sine ? std::sin(0.5 * n * angle) : std::cos(0.5 * n * angle)));
    });
    terms.push_back(x * x);
    return terms;
  }


  void HalfPowerFit::add(const double r,
                         const double angle,
                         const double value,
                         const double weight)
  {
    const std::vector<double> terms = terms_at(r, angle);
    const std::size_t         n     = terms.size();
    for (std::size_t i = 0; i < n; ++i)
      {
        right_side[i] += weight * terms[i] * value;
        for (std::size_t j = 0; j < n; ++j)
          matrix[i * n + j] += weight * terms[i] * terms[j];
      }
  }


  void HalfPowerFit::solve(const MPI_Comm communicator)
  {
    const std::size_t   n = right_side.size();
    std::vector<double> all(n * n), right(n);
    dealii::Utilities::MPI::sum(matrix, communicator, all);
    dealii::Utilities::MPI::sum(right_side, communicator, right);
    const Eigen::MatrixXd square = Eigen::Map<const Eigen::MatrixXd>(all.data(), n, n);
    const Eigen::VectorXd found =
      Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(square).solve(
        Eigen::Map<const Eigen::VectorXd>(right.data(), n));
    coefficients.assign(found.data(), found.data() + n);
  }


  double HalfPowerFit::value(const double r, const double angle) const
  {
    const std::vector<double> terms = terms_at(r, angle);
    double                    sum   = 0.;
    for (std::size_t i = 0; i < terms.size(); ++i)
      sum += coefficients[i] * terms[i];
    return sum;
  }


  double HalfPowerFit::slope_ahead(const double r, const double angle) const
  {
    // d/dx of z^(n/2), real and imaginary part, is n/2 z^(n/2 - 1).
    const double x   = r / scale;
    double       sum = 0.;
    std::size_t  k   = 0;
    for_each_term([&](const int n, const bool sine) {
      const double power = 0.5 * n - 1.;
      sum += coefficients[k++] * 0.5 * n * std::pow(x, power) *
             (sine ? std::sin(power * angle) : std::cos(power * angle));
    });
    return (sum + coefficients[k] * 2. * x * std::cos(angle)) / scale;
  }
} // namespace PeriDeal
