// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/bounds/spectrum.h>
#include <perideal/scene/scene.h>
#include <perideal/solvers/stepper.h>

#include <nlohmann/json.hpp>

namespace PeriDeal
{
  /** What the summary says of a scene of diffusion: sides and what holds there. */
  template <int dim>
  void describe_diffusion_scene(const Scene<dim> &scene, nlohmann::ordered_json &summary);

  /** What the steps have come to, and which explicit ones would be stable. */
  nlohmann::ordered_json describe_stepping(const Stepper &stepper, const Spectrum &spectrum);
} // namespace PeriDeal
