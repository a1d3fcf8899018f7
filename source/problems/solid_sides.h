// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/problems/solid_problem.h>

#include <nlohmann/json.hpp>

#include <string>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /**
   * The mean displacement, by area, of each side that has a condition on its displacement or
   * traction, with the name that the user gave it: of a body with nodes at cell centres that of its
   * outermost nodes. Collective.
   */
  template <int dim>
  std::vector<std::pair<std::string, dealii::Tensor<1, dim>>> displacements_of_sides(
    const SolidProblem<dim> &model,
    const Scene<dim>        &scene);

  /**
   * Keep in @p extremes the largest component of a force on any side so far, as `largest force`
   * (`value`, `side`, `direction`, `time`). Of a pull and a support that are equal but for
   * round-off the pull counts; none, as where the arms of a cantilever are pushed apart, if all are
   * round-off beside the @p scale, find_force_scale().
   */
  void keep_largest_force(const ForceBalance     &balance,
                          const double            scale,
                          const double            t,
                          nlohmann::ordered_json &extremes);

  /** `force 12.3 on top in y`, of the largest component now; empty without any. */
  std::string text_of_largest_force(const ForceBalance &balance, const double scale);
} // namespace PeriDeal
