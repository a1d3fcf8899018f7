// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

namespace PeriDeal
{
  /** Volume of the ball of radius delta: 2 delta, pi delta^2, 4 pi delta^3/3. */
  double ball_volume(const unsigned int dim, const double delta);

  /**
   * Factor of a bond by the volume method, 2 V_0/(V_i + V_j), with the volumes of both ends'
   * families and that of a complete one (Le and Bobaru 2018, "Surface corrections for peridynamic
   * models in elasticity and fracture"). At least 1 where families are cut, 2 between two halves.
   */
  double volume_factor(const double complete, const double one, const double other);
} // namespace PeriDeal
