// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/geometry_info.h>

#include <array>
#include <vector>

namespace PeriDeal
{
  /**
   * A bond between two sites of a lattice of cells, cut where it crosses from cell to cell. Pure
   * geometry in units of the spacing: lengths do not enter, so a table holds for rectangles and
   * bricks too.
   *
   * A field that is interpolated linearly between the corners of each cell changes along a piece by
   * sum_a change_a T_a, a the corners of a cell around the piece. So the piece conducts like L =
   * change change^T/length (secant rule: exact where the field is linear on the piece).
   */
  template <int dim>
  struct BondPiece
  {
    using Site    = std::array<int, dim>;
    using Corners = std::array<double, dealii::GeometryInfo<dim>::vertices_per_cell>;

    double length; // part of the bond, all pieces add up to 1
    // The cells that share the piece: one, or those around a face or an edge; lowest corner
    // relative to the bond's start.
    std::vector<Site>    cells;
    std::vector<Corners> change; // of the shape functions along the piece, for each of the cells
  };


  /** The pieces of the bond from the origin to a site, in this order. @p offset is not zero. */
  template <int dim>
  std::vector<BondPiece<dim>> bond_pieces(const typename BondPiece<dim>::Site &offset);
} // namespace PeriDeal
