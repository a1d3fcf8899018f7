// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/problems/guards.h>

#include "guard_causes.h"

namespace PeriDeal
{
  template <int dim>
  class DiffusionProblem;

  /**
   * What the guards of a run look for in diffusion, and what brings it about. Functions are
   * collective unless they say otherwise.
   */
  template <int dim>
  class DiffusionGuards
  {
  public:
    /** Refers to it. */
    explicit DiffusionGuards(DiffusionProblem<dim> &problem);

    /** As Problem::steps_between_looks(). Not collective. */
    unsigned int steps_between_looks() const;

    /** As Problem::watch(). */
    Trip watch(const double t);

    /** As Problem::watch_totals(). Not collective. */
    Trip watch_totals(const double t) const;

    /** As Problem::explain(). */
    void explain(Trip &trip) const;

  private:
    DiffusionProblem<dim> &problem;
    GrowthGuard            growth;
    StepGuard              steps;
  };
} // namespace PeriDeal
