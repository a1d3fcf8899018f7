// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/point.h>

#include <perideal/analysis/crack_surface.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /** From where a crack may grow: a point (2D: both ends are the same), or edges (3D). */
  template <int dim>
  struct CrackFront
  {
    std::string                                    name;
    std::vector<std::array<dealii::Point<dim>, 2>> edges;

    double distance(const dealii::Point<dim> &p) const;
  };


  /** How far a crack has grown from a front. */
  template <int dim>
  struct CrackAdvance
  {
    dealii::Point<dim> tip;
    double             length = 0.; // of the shortest path along the crack, from front to tip
    double             speed  = 0.;
    unsigned int       n_tips = 0;
  };


  /**
   * Facets have been reached from a front if they are connected, with gaps of at most @p reach
   * between their corners and at the front; a corner belongs to the nearest front along this path.
   * The tip is the farthest one; of several that are equally far (to 0.05 reach) the mean of those
   * that are connected, of separate ones the first in space. Where no other corner of the same
   * front within the reach is farther, that is a tip, too: `n_tips` counts those that are connected
   * as one.
   *
   * The speed is that of a straight line fitted, in the mean over all instants, to the path length
   * as a function of time since the crack was 4 reach shorter; 0 before it has grown by one.
   *
   * The same on all processes if facets are. Not collective.
   * @param time the current one
   */
  template <int dim>
  std::vector<CrackAdvance<dim>> find_advances(const std::vector<CrackFacet<dim>> &facets,
                                               const std::vector<CrackFront<dim>> &fronts,
                                               const double                        reach,
                                               const double                        time);

  /**
   * The speed of what has come so far at some times, @p now the last one, over the last @p span of
   * its path.
   */
  double fitted_speed(std::vector<std::pair<double, double>> times_and_ways,
                      const double                           span,
                      const double                           now);
} // namespace PeriDeal
