// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/grid/tria.h>

#include <functional>
#include <string>

namespace PeriDeal
{
  /**
   * A cause of runs that diverge which lies in the body: a material that differs so much between
   * two cells side by side that solvers do not get across, or that the round-off of one is no less
   * than what the other takes part with. One pass over the cells. Collective.
   * @param entry    of the property, quoted, as `'Conductivity'`
   * @param property of a point, which may report errors of formulas
   * @param monitor  what has tripped: `solver` or `balance`
   * @return sentences; empty where it does not hold, and for other monitors
   */
  template <int dim>
  std::string cause_in_contrast(const dealii::Triangulation<dim>                        &mesh,
                                const std::string                                       &entry,
                                const std::function<double(const dealii::Point<dim> &)> &property,
                                const std::string                                       &monitor);
} // namespace PeriDeal
