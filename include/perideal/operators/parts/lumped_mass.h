// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/lac/vector.h>

namespace PeriDeal
{
  /**
   * The lumped masses of a cell, sum_b int rho N_a N_b. Those of quadratic elements are positive
   * where rho is constant, but where it jumps within the cell some may come out negative, since
   * their N_a are negative in part of it. Then all become shares of the cell's mass in proportion
   * to the diagonal int rho N_a^2, which are the same where rho is constant and the cell is a
   * parallelepiped (Hinton, Rock, Zienkiewicz 1976). Not collective.
   *
   * @param diagonal int rho N_a^2
   * @param sums     of the rows; changed in place
   */
  inline void make_positive(const dealii::Vector<double> &diagonal, dealii::Vector<double> &sums)
  {
    constexpr double least = 0.25; // of that share: tiny masses have tiny stable steps
    double           mass = 0., trace = 0.;
    for (unsigned int a = 0; a < sums.size(); ++a)
      {
        mass += sums(a);
        trace += diagonal(a);
      }
    if (!(trace > 0.)) // a steady state may have none
      return;
    const double share = mass / trace;
    bool         good  = true;
    for (unsigned int a = 0; a < sums.size(); ++a)
      good = good && sums(a) >= least * share * diagonal(a);
    if (!good)
      for (unsigned int a = 0; a < sums.size(); ++a)
        sums(a) = share * diagonal(a);
  }
} // namespace PeriDeal
