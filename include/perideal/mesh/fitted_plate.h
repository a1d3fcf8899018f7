// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/point.h>

#include <perideal/scene/holes.h>

#include <array>
#include <string>
#include <vector>

namespace PeriDeal
{
  /** Quadrilaterals, counterclockwise. */
  struct FittedPlate
  {
    std::vector<dealii::Point<2>>            vertices;
    std::vector<std::array<unsigned int, 4>> cells;
  };

  /**
   * A mesh of a rectangle with holes whose edges lie on the rims of the holes: the lattice of the
   * rectangle without the cells in and near a hole, and one row of cells between what is left of it
   * and the rim, the corners of polygons among its vertices. Polygons all of whose edges lie on
   * lines of the lattice need no such row; they alone may reach the sides of the rectangle.
   *
   * Throws UserError where cells are too large for what lies between holes and sides.
   * @param where entry and section for messages
   */
  FittedPlate fitted_plate(const dealii::Point<2>            &lower,
                           const dealii::Point<2>            &upper,
                           const std::array<unsigned int, 2> &n_cells,
                           const std::vector<Hole>           &holes,
                           const std::string                 &where);
} // namespace PeriDeal
