// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/dofs/dof_handler.h>

#include <perideal/mesh/part_faces.h>
#include <perideal/scene/boundary_conditions.h>

#include <vector>

namespace PeriDeal
{
  /**
   * A node of a region, or the one nearest to a point, and its share of the region's volume; the
   * shares of a part have the sum 1.
   */
  struct PartNode
  {
    unsigned int               node; // local number
    dealii::types::boundary_id id;   // of the part
    double                     share;
  };

  /**
   * The nodes of regions and points among those of this process.
   *
   * @param positions, volumes of this process's own nodes. Of nodes equally near to a point the one
   *                   with the smallest coordinates counts.
   * Throws UserError for a region without nodes. Collective.
   */
  template <int dim>
  std::vector<PartNode> nodes_of_parts(const BoundaryConditions<dim>         &conditions,
                                       const std::vector<dealii::Point<dim>> &positions,
                                       const std::vector<double>             &volumes,
                                       const MPI_Comm                         communicator);

  /**
   * An error on all processes if the area found for a part of a side, of this process, is zero
   * everywhere. Collective.
   */
  template <int dim>
  void require_areas(const BoundaryConditions<dim> &conditions,
                     const std::vector<double>     &areas,
                     const MPI_Comm                 communicator);

  template <int dim, typename Cell>
  CellVertices<dim> vertices_of(const Cell &cell)
  {
    CellVertices<dim> vertices;
    for (unsigned int v = 0; v < vertices.size(); ++v)
      vertices[v] = cell->vertex(v);
    return vertices;
  }
} // namespace PeriDeal
