// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/problems/solid_problem.h>

#include <nlohmann/json.hpp>

#include <memory>
#include <vector>

namespace PeriDeal
{
  /** What the summary says of a body as a solid: solver, sides and what holds there. */
  template <int dim>
  void describe_solid_scene(const Scene<dim>       &scene,
                            const bool              at_the_end,
                            nlohmann::ordered_json &summary);

  /** Steps and iterations of Problem::describe_solving(). */
  template <int dim>
  nlohmann::ordered_json describe_solving_of(const SolidProblem<dim> &problem);

  /**
   * The size of forces in the body now, against which a sum of forces that should be zero is small
   * or not: what passes through it (@p throughput), and its mean Young modulus times the area of a
   * cube on its shortest edge times the strain by which displacements differ over that edge: a body
   * that is free to expand bears nothing but round-off, which is small against the latter.
   * Collective.
   */
  template <int dim>
  double find_force_scale(const SolidProblem<dim> &model,
                          const Scene<dim>        &scene,
                          const double             throughput);
} // namespace PeriDeal
