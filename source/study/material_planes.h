// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/scene.h>

#include <optional>
#include <vector>

namespace PeriDeal
{
  /**
   * Coordinates at which the material of a box jumps, for each direction: interfaces of layers and
   * of upright boxes. On lattices that have lines there each cell is of one material. Nothing if
   * some interface is oblique or round, or there are none. Found along lines through the body, so
   * what is thinner than 1/1024 of an edge, or 1/16 (3D: 1/6) of it across, may be missed. Not
   * collective.
   */
  template <int dim>
  std::optional<std::vector<std::vector<double>>> material_planes(const Scene<dim> &scene);
} // namespace PeriDeal
