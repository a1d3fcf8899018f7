// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/problems/run_context.h>
#include <perideal/problems/solid_problem.h>

namespace PeriDeal
{
  /**
   * Processor seconds of one equilibrium; -1 where the solver does not get there: the run will say
   * why. Throws UserError, where it must be held, for a body with a part that nothing holds.
   * Collective.
   */
  double time_of_linear_equilibrium(const SolverControlParameters &control,
                                    ElasticOperator               &op,
                                    const double                   t,
                                    const bool                     must_be_held);

  /**
   * Seconds that the equilibria of a body take, negative if that is not known: a linear one is
   * solved, of a large body on a coarser lattice. Bonds that break take more.
   * @param n_steps of loading
   * @param memory raised to what the run of a large body takes at least beyond what is there before
   *               it. Collective.
   */
  template <int dim>
  double time_of_equilibria(const SolidProblem<dim> &problem,
                            const double             n_steps,
                            const RunContext        &context,
                            double                  &memory);
} // namespace PeriDeal
