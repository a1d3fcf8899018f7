// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/problems/diffusion_problem.h>
#include <perideal/problems/run_context.h>

namespace PeriDeal
{
  /**
   * Rows of totals.csv of diffusion, and what the summary says of a time. Throws UserError if not
   * finite. Collective.
   */
  template <int dim>
  void add_diffusion_totals(DiffusionProblem<dim> &problem,
                            const double           t,
                            const RunContext      &context);

  /**
   * Of the heat that a solid has its temperature from: what flows through the sides, and what has
   * entered and is stored since the start, beside the solid's own rows. Collective.
   */
  template <int dim>
  void add_heat_totals_of_solid(DiffusionProblem<dim> &heat,
                                const double           t,
                                const RunContext      &context);
} // namespace PeriDeal
