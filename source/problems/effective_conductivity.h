// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/interface/operator.h>
#include <perideal/scene/scene.h>

#include <optional>

namespace PeriDeal
{
  /**
   * What a box or an image, voids included, conducts as a whole: heat times length over area and
   * difference of temperature, if two opposite sides are held at different constant values and all
   * others are insulated or symmetry planes. The heat is the mean of what enters at one side and
   * leaves at the other, which is the same in the steady state only: the caller asks whether it is.
   */
  template <int dim>
  std::optional<double> effective_conductivity(const Scene<dim> &scene, const Balance &balance);
} // namespace PeriDeal
