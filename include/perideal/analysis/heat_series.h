// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

namespace PeriDeal
{
  /** Value and x-derivative of a solution in one variable. */
  struct ValueAndSlope
  {
    double value, slope;
  };

  /**
   * The classical one-dimensional solutions from which those of the papers are made: each solves
   * dT/dt = T'' on [0,1], in units of the length L and of the time L^2/alpha, and slopes are per
   * unit of x/L. Terms are added until the next ones are below 1e-16 of the first. At t = 0 (and
   * below 1e-11) the initial value, with the prescribed value at Dirichlet ends.
   */
  namespace HeatSeries
  {
    /**
     * Both ends 0, initially 1 (Bobaru 2010, eq 33 with its missing 1/n; a factor of Bobaru 2012,
     * example 1).
     */
    ValueAndSlope cooling_slab(const double x, const double t);

    /**
     * Left end insulated, right end held at @p right, initially @p first up to 1/2 and @p second
     * beyond (Bobaru 2010, eq 38 with its second minus a plus).
     */
    ValueAndSlope two_part_bar(const double x,
                               const double t,
                               const double first,
                               const double second,
                               const double right);

    /**
     * Left end held at @p left, given slope dT/dx = @p slope at the right end, initially 0 (Bobaru
     * 2010, eq 43 with sin(n x/2); Bobaru 2012, eq 18 with slope 0, whose flux, eq 19, is times
     * beta_n and not divided by it).
     */
    ValueAndSlope heated_bar(const double x, const double t, const double left, const double slope);
  } // namespace HeatSeries
} // namespace PeriDeal
