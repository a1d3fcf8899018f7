// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/analysis/exact_solution.h>
#include <perideal/problems/solid_problem.h>

#include <vector>

namespace PeriDeal
{
  /**
   * Of the displacements at the nodes, weighted by their volumes; nodes where the solution has no
   * single value, on the faces of a crack, and those of extra layers do not count. Collective.
   */
  template <int dim>
  Difference error_of_displacement(const SolidProblem<dim> &problem,
                                   const ExactSolution     &exact,
                                   const double             t);

  /**
   * What solid_columns() have of a known displacement: stresses by the material at the point, no
   * numbers if the solution does not tell its gradient, and for a temperature. Not collective.
   */
  template <int dim>
  std::vector<double> exact_row_of_solid(const Scene<dim>         &scene,
                                         const ExactSolution      &exact,
                                         const dealii::Point<dim> &point,
                                         const double              t);
} // namespace PeriDeal
