// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/point.h>

#include <array>
#include <vector>

namespace PeriDeal
{
  /** Corners of a cell Q1 in deal.II's order. */
  template <int dim>
  using CellCorners = std::array<dealii::Point<dim>, dealii::GeometryInfo<dim>::vertices_per_cell>;

  /** Values of the cell's shape functions Q1 at a point of the unit cell. */
  template <int dim>
  std::array<double, dealii::GeometryInfo<dim>::vertices_per_cell> shape_values(
    const dealii::Point<dim> &unit);

  /**
   * The point of the unit cell that the multilinear mapping takes to p, to round-off; @p unit is
   * where the search for it starts. Returns false far outside of the cell, where there may be none.
   */
  template <int dim>
  bool unit_point(const CellCorners<dim>   &corners,
                  const dealii::Point<dim> &p,
                  dealii::Point<dim>       &unit);

  /** Determinant of the mapping's Jacobian at a point of the unit cell. */
  template <int dim>
  double volume_element(const CellCorners<dim> &corners, const dealii::Point<dim> &unit);

  /**
   * Append the places s at which the line a + s (b - a) passes the faces of a cell, extended a
   * little beyond their edges; not those at which it lies within a face. 2D: straight edges. 3D:
   * bilinear faces, which two cells share exactly.
   */
  template <int dim>
  void add_face_crossings(const CellCorners<dim>   &corners,
                          const dealii::Point<dim> &a,
                          const dealii::Point<dim> &b,
                          std::vector<double>      &places);
} // namespace PeriDeal
