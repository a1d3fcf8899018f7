// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace PeriDeal
{
  /**
   * By how much a_m of themselves weights w_m >= 0 with moments mu_m have to grow, so that their
   * sum grows by a gap: of all a_m >= 0 those that come nearest to it, and of these the least, sum
   * w_m a_m^2 (non-negative least squares). They are the positive parts of multipliers . mu_m.
   * @param ridge what can be met is met to about this, relatively; where a gap cannot be met,
   *              round-off is made 1/ridge times larger
   */
  template <std::size_t n_moments>
  std::vector<double> least_additions(const std::vector<std::array<double, n_moments>> &moments,
                                      const std::vector<double>                        &weight,
                                      const std::array<double, n_moments>              &gap,
                                      const double                                      ridge)
  {
    const auto product = [&](const std::size_t m, const dealii::Vector<double> &multipliers) {
      double sum = 0.;
      for (std::size_t n = 0; n < n_moments; ++n)
        sum += moments[m][n] * multipliers[n];
      return sum;
    };
    const dealii::Vector<double> right(gap.begin(), gap.end());
    double                       all = 0.;
    for (std::size_t m = 0; m < moments.size(); ++m)
      for (std::size_t n = 0; n < n_moments; ++n)
        all += weight[m] * moments[m][n] * moments[m][n];
    constexpr double smallest = 1e-15; // part of a step: far bonds may join after as little
    const double     least    = ridge * all;
    // The multipliers are where a concave function of them is largest.
    const auto value = [&](const dealii::Vector<double> &multipliers) {
      double sum = right * multipliers - 0.5 * least * multipliers.norm_sqr();
      for (std::size_t m = 0; m < moments.size(); ++m)
        {
          const double grows = std::max(0., product(m, multipliers));
          sum -= 0.5 * weight[m] * grows * grows;
        }
      return sum;
    };
    dealii::Vector<double> multipliers(n_moments), step(n_moments), gradient(n_moments);
    for (unsigned int round = 0; round < 50 && all > 0.; ++round) // Newton's method
      {
        dealii::FullMatrix<double> matrix(n_moments);
        gradient = right;
        gradient.add(-least, multipliers);
        for (std::size_t n = 0; n < n_moments; ++n)
          matrix(n, n) = least;
        for (std::size_t m = 0; m < moments.size(); ++m)
          if (const double grows = product(m, multipliers); grows > 0. || round == 0)
            for (std::size_t n = 0; n < n_moments; ++n)
              {
                gradient[n] -= weight[m] * grows * moments[m][n];
                for (std::size_t k = 0; k < n_moments; ++k)
                  matrix(n, k) += weight[m] * moments[m][n] * moments[m][k];
              }
        if (gradient.linfty_norm() < 1e-11 * right.linfty_norm())
          break;
        matrix.gauss_jordan();
        matrix.vmult(step, gradient);
        const double before = value(multipliers), expected = step * gradient;
        double       part = 1.;
        for (dealii::Vector<double> tried = multipliers; part > smallest; part *= 0.5)
          {
            tried = multipliers;
            tried.add(part, step);
            if (value(tried) >= before + 1e-4 * part * expected)
              {
                multipliers = tried;
                break;
              }
          }
        if (part <= smallest)
          break;
      }
    std::vector<double> additions(moments.size());
    for (std::size_t m = 0; m < moments.size(); ++m)
      additions[m] = std::max(0., product(m, multipliers));
    return additions;
  }
} // namespace PeriDeal
