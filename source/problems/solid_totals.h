// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/problems/run_context.h>
#include <perideal/problems/solid_problem.h>

namespace PeriDeal
{
  /**
   * Rows of totals.csv of a body, and what the summary says of a time: forces on sides, energies,
   * mean stress, stress intensities. Throws UserError if they are not finite. Collective.
   */
  template <int dim>
  void add_solid_totals(SolidProblem<dim> &problem, const double t, const RunContext &context);
} // namespace PeriDeal
