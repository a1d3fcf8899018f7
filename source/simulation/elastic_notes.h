// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/simulation/elastic_run.h>

#include "run_context.h"

namespace PeriDeal
{
  /** Say once where the first bond of a body broke, and keep it. */
  template <int dim>
  void tell_first_break(const ElasticRun<dim> &run, const double t, const RunContext<dim> &context);

  /**
   * What the user should know at the end of a run: steps that became shorter, an energy balance
   * that does not close, cells turned inside out, bonds torn off beside loads. Collective.
   */
  template <int dim>
  void note_end(const ElasticRun<dim> &run, const RunContext<dim> &context);
} // namespace PeriDeal
