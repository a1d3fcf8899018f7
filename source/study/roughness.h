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
   *   with h^(2a). Of four quadrants a = 4/pi atan(1/sqrt(R)) if they have the moduli R, 1, R, 1
   *   (Kellogg 1975), which is taken with R = sqrt(m_1 m_3/(m_2 m_4)) of others, too.
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
