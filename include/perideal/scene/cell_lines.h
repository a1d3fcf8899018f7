// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/domain.h>

#include <array>
#include <vector>

namespace PeriDeal
{
  /**
   * Of a box that is no lattice, by its entry `Cell lines`: the coordinates of the lines (in 3D
   * planes) between its cells, for each direction, from one side to the other. Throws UserError.
   */
  template <int dim>
  std::array<std::vector<double>, dim> cell_lines(const Domain<dim> &domain);
} // namespace PeriDeal
