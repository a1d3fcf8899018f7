// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/elasticity_control.h>

#include <optional>

namespace PeriDeal
{
  /**
   * With `Heat of deformation = true` the absolute temperature of the unstressed body, of a section
   * that has been parsed; else none.
   */
  std::optional<double> absolute_reference(const ElasticityControl &control);

  /**
   * Throws UserError: `Heat of deformation` without a temperature that is computed or without
   * `Absolute zero`, and that without the other or not below `Reference temperature`. For
   * ElasticityControl::parse().
   */
  void check_heat_of_deformation(const ElasticityControl &control);
} // namespace PeriDeal
