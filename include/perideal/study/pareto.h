// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <cstddef>
#include <vector>

namespace PeriDeal
{
  /** What a setting costs, and how wrong it is; both positive. */
  struct WorkPoint
  {
    double cost = 0., error = 0.;
  };

  /** Means "no point". */
  constexpr std::size_t no_point = static_cast<std::size_t>(-1);

  /** Whether @p a is neither dearer nor more wrong than @p b, and better in one of the two. */
  bool dominates(const WorkPoint &a, const WorkPoint &b);

  /**
   * The points that none dominates, by rising cost; points equal in both are all in it, in the
   * order given.
   */
  std::vector<std::size_t> pareto_front(const std::vector<WorkPoint> &points);

  /**
   * For each point the cheapest of the front that dominates it, the first of several; no_point on
   * the front.
   */
  std::vector<std::size_t> dominating_points(const std::vector<WorkPoint> &points);

  /**
   * The order p of error = C h^p by least squares in logarithms. NaN for fewer than two different
   * spacings, or numbers that are not positive.
   */
  double observed_order(const std::vector<double> &spacings, const std::vector<double> &errors);

  /** How far costs are extrapolated: down to this part of the finest point's error. */
  constexpr double farthest_extrapolation = 10.;

  /** What an error costs along a family of settings. */
  struct CostAtError
  {
    enum class Kind
    {
      interpolated, // between two points of the family
      extrapolated, // beyond its finest point, with the slope of its last three
      // The cost of a point that is better: of the coarsest, or of one no dearer than the point
      // before.
      at_most,
      none // fewer than two points, too far beyond them, or the error does not become smaller
    };

    Kind   kind   = Kind::none;
    double cost   = 0.; // meaningless with none
    double beyond = 1.; // extrapolated: the finest point's error over the target
  };

  /**
   * The cost at which a family reaches @p error for good, by lines in logarithms of cost and error.
   *
   * @param family points from coarse to fine
   */
  CostAtError cost_at_error(const std::vector<WorkPoint> &family, const double error);

  /**
   * The order p seen in three solutions on lattices refined by two, from the norms of their
   * differences: log2(coarse/fine), where @p coarse is |u(2h) - u(4h)| and @p fine |u(h) - u(2h)|.
   */
  double order_of_differences(const double coarse, const double fine);

  /** u(h) + (u(h) - u(2h))/(2^p - 1), value by value. */
  std::vector<double> richardson(const std::vector<double> &coarse,
                                 const std::vector<double> &fine,
                                 const double               order);
} // namespace PeriDeal
