// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/problems/diffusion_problem.h>
#include <perideal/problems/solid_problem.h>

namespace PeriDeal
{
  /**
   * The temperature above the reference at the nodes of the elastic model. Both models have the
   * same element on the same mesh, but may number its nodes differently; each node has the same
   * owner in both.
   */
  template <int dim>
  void find_temperature_change(const DiffusionProblem<dim> &heat,
                               const SolidProblem<dim>     &solid,
                               const double                 reference,
                               Vector                      &change);
} // namespace PeriDeal
