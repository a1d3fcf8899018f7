// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/problems/diffusion_problem.h>
#include <perideal/problems/run_context.h>

namespace PeriDeal
{
  /**
   * Rows of totals.csv of what diffuses, and what the summary says of a time. Throws UserError if
   * not finite. Collective.
   */
  template <int dim>
  void add_diffusion_totals(DiffusionProblem<dim> &problem,
                            const double           t,
                            const RunContext      &context);
} // namespace PeriDeal
