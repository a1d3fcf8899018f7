// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/problems/solid_problem.h>

#include <nlohmann/json.hpp>

#include <string>

namespace PeriDeal
{
  /**
   * The statistics of a model's phases for summary.json, at the end of the run; their rows are
   * appended to those of totals.csv. Empty without phases. Collective.
   */
  template <int dim>
  nlohmann::ordered_json describe_phases(const SolidProblem<dim> &model,
                                         const Scene<dim>        &scene,
                                         std::string             &totals,
                                         const MPI_Comm           communicator);
} // namespace PeriDeal
