// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/simulation/simulation.h>

#include <nlohmann/json.hpp>

#include <string>

namespace PeriDeal
{
  /**
   * "lower" and "upper", between which the true flow through the side of `Measure` lies, whatever
   * an estimate says, and a "reservation" if something is not bounded. Of steady diffusion by
   * finite elements; null for others (EnergyBounds::why_not()). Collective.
   */
  template <int dim>
  nlohmann::ordered_json guaranteed_flow(const Scene<dim> &scene, Simulation<dim> &simulation);

  /**
   * "energy", of a static equilibrium by finite elements: the `bound` of the energy norm of the
   * error, the same `relative` to that of the displacement, and a "reservation" if something is not
   * bounded; null for others (ElasticBounds::why_not()). Collective.
   */
  template <int dim>
  nlohmann::ordered_json guaranteed_energy(const Scene<dim> &scene, Simulation<dim> &simulation);

  /** One of these, not null, in words. */
  std::string guaranteed_text(const nlohmann::ordered_json &told, const std::string &side);
} // namespace PeriDeal
