// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/scene.h>
#include <perideal/study/cracked_box.h>

#include <optional>
#include <vector>

namespace PeriDeal
{
  /**
   * The order with which errors get smaller where something in a box is rougher than the solution
   * elsewhere, whatever the elements are; a large number where nothing is:
   *
   * - where planes of materials cross. The solution goes there with r^a, and the error of a field
   *   with h^(2a). Of four quadrants with the moduli R, 1, R, 1 a = 4/pi atan(1/sqrt(R)) (Kellogg
   *   1975); in solids that of the shear moduli is taken.
   * - 1 where a crack ends on such a plane
   * - 1 in a body at rest that a load meets at t = 0: kinks travel through it
   *
   * @param planes of material_planes(), or none. Not collective.
   */
  template <int dim>
  double order_of_rough_places(const Scene<dim>                                      &scene,
                               const CrackedBox                                      &box,
                               const std::optional<std::vector<std::vector<double>>> &planes);
} // namespace PeriDeal
