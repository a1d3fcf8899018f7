// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <algorithm>
#include <array>
#include <vector>

namespace PeriDeal
{
  /**
   * By how much of themselves weights w_m >= 0 with moments mu_m have to grow, so that their sum
   * grows by a gap: of all additions the least (in the mean of their weights), w_m times the
   * positive part of multipliers . mu_m. Nothing gets less. Directions in which there are no
   * weights keep their gap.
   */
  template <std::size_t n_moments>
  std::vector<double> least_additions(const std::vector<std::array<double, n_moments>> &moments,
                                      const std::vector<double>                        &weight,
                                      const std::array<double, n_moments>              &gap)
  {
    const auto product = [&](const std::size_t m, const dealii::Vector<double> &multipliers) {
      double sum = 0.;
      for (std::size_t n = 0; n < n_moments; ++n)
        sum += moments[m][n] * multipliers[n];
      return sum;
    };
    const dealii::Vector<double> right(gap.begin(), gap.end());
    dealii::Vector<double>       multipliers(n_moments);
    std::vector<bool>            grows(moments.size(), true);
    // Which are positive is found by turns with the multipliers (Newton's method).
    for (unsigned int round = 0; round < 50; ++round)
      {
        dealii::FullMatrix<double> matrix(n_moments);
        for (std::size_t m = 0; m < moments.size(); ++m)
          if (grows[m])
            for (std::size_t n = 0; n < n_moments; ++n)
              for (std::size_t k = 0; k < n_moments; ++k)
                matrix(n, k) += weight[m] * moments[m][n] * moments[m][k];
        const double least = 1e-9 * matrix.linfty_norm();
        if (!(least > 0.))
          break;
        for (std::size_t n = 0; n < n_moments; ++n)
          matrix(n, n) += least;
        matrix.gauss_jordan();
        matrix.vmult(multipliers, right);
        bool changes = false;
        for (std::size_t m = 0; m < moments.size(); ++m)
          {
            const bool positive = product(m, multipliers) > 0.;
            changes             = changes || positive != grows[m];
            grows[m]            = positive;
          }
        if (!changes)
          break;
      }
    std::vector<double> additions(moments.size());
    for (std::size_t m = 0; m < moments.size(); ++m)
      additions[m] = std::max(0., product(m, multipliers));
    return additions;
  }
} // namespace PeriDeal
