// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <vector>

namespace PeriDeal
{
  /**
   * Order p of error ~ size^p between two runs: log(e1/e2)/log(s1/s2). All four positive, sizes
   * different.
   */
  double observed_order(const double first_size,
                        const double first_error,
                        const double second_size,
                        const double second_error);

  /** The order between each run and the next: one number fewer than runs. */
  std::vector<double> observed_orders(const std::vector<double> &sizes,
                                      const std::vector<double> &errors);

  /**
   * Slope of the straight line fitted to log(error) over log(size) by least squares (how Bobaru
   * 2010 and 2012 state rates); two runs or more.
   */
  double least_squares_order(const std::vector<double> &sizes, const std::vector<double> &errors);

  /** ||reference - values||_2 / ||reference||_2 over nodes (Bobaru 2012, eq 13). */
  double relative_l2_difference(const std::vector<double> &reference,
                                const std::vector<double> &values);

  /**
   * (1/N) || (reference - values)/reference ||_2: what the rates in Figs 11 and 12 of Bobaru 2010
   * are of, although its eq 45 prints the square of it times N. Nodes where the reference is
   * exactly zero are left out and not counted in N.
   */
  double scaled_relative_difference(const std::vector<double> &reference,
                                    const std::vector<double> &values);
} // namespace PeriDeal
