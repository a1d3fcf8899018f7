// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/crack_geometry.h>

#include <vector>

namespace PeriDeal
{
  /** Whether some crack separates two vertices of a cell. @tparam Cell an accessor or iterator of deal.II */
  template <int dim, typename Cell>
  bool is_cut(const Cell &cell, const std::vector<CrackGeometry<dim>> &cracks)
  {
    for (const CrackGeometry<dim> &crack : cracks)
      if (crack.is_near(cell->center(), cell->diameter()))
        for (const unsigned int a : cell->vertex_indices())
          for (unsigned int b = 0; b < a; ++b)
            if (crack.separates(cell->vertex(a), cell->vertex(b)))
              return true;
    return false;
  }
} // namespace PeriDeal
