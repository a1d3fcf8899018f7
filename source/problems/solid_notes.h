// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/problems/run_context.h>
#include <perideal/problems/solid_problem.h>

namespace PeriDeal
{
  /** Say once where the first bond of a body broke, and keep it. */
  template <int dim>
  void tell_first_break(const SolidProblem<dim> &run, const double t, const RunContext &context);

  /**
   * That pieces of the body overlap (BodyPieces) at t; said once. Collective. Throws UserError, at
   * rest.
   */
  template <int dim>
  void note_overlap(const SolidProblem<dim> &run, const double t, const RunContext &context);

  /**
   * What is wrong with the equilibrium that has been found at t: pieces of the body that overlap
   * (BodyPieces), a residual that round-off keeps above the tolerance; each is said once.
   * Collective. Throws UserError.
   */
  template <int dim>
  void note_equilibrium(const SolidProblem<dim> &run, const double t, const RunContext &context);

  /**
   * What the user should know at the end of a run: steps that became shorter, an energy balance
   * that does not close, cells turned inside out, bonds torn off beside loads. Collective.
   */
  template <int dim>
  void note_end(const SolidProblem<dim> &run, const RunContext &context);
} // namespace PeriDeal
