// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/grid/tria_description.h>

#include <perideal/scene/crack_geometry.h>

#include <vector>

namespace PeriDeal
{
  /** A coarse mesh as plain lists. */
  template <int dim>
  struct CoarseMesh
  {
    std::vector<dealii::Point<dim>>    vertices;
    std::vector<dealii::CellData<dim>> cells;
  };

  /** Length (2D) or area (3D) of a crack that lies on interior faces of the mesh. */
  template <int dim>
  double measure_on_faces(const CoarseMesh<dim> &mesh, const CrackGeometry<dim> &crack);

  /**
   * Whether all of a crack that is inside the body lies on whole interior faces of the mesh: then
   * both cells beside each piece hold that piece, while a piece inside a cell is held by one cell
   * only. The crack may leave the body.
   */
  template <int dim>
  bool lies_on_faces(const CoarseMesh<dim> &mesh, const CrackGeometry<dim> &crack);

  /**
   * Cut cracks that lie on cell faces into a coarse mesh: around each vertex on a crack the cells
   * fall into groups connected through faces that are not on a crack; every group but the first
   * gets a vertex of its own. So crack tips stay closed, crossings and cracks that leave the body
   * open up.
   */
  template <int dim>
  void cut_along_faces(CoarseMesh<dim> &mesh, const std::vector<CrackGeometry<dim>> &cracks);
} // namespace PeriDeal
