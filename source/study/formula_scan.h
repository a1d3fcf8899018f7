// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/scene.h>

namespace PeriDeal
{
  /**
   * How many cells along the longest edge of the box of a scene its formulas need: the fewest, of
   * powers of two, on which the linear interpolant of each is right to a fifth of its variation in
   * the mean square. Sources, conductivity and forces in the body, and given values on its sides;
   * at most as many as are looked at. A solution on coarser cells may have missed what they
   * describe. Not collective.
   */
  template <int dim>
  double fineness_of_formulas(const Scene<dim> &scene);
} // namespace PeriDeal
