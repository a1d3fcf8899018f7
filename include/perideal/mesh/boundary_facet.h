// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/dofs/dof_handler.h>

#include <perideal/mesh/point_bins.h>

#include <algorithm>
#include <array>
#include <vector>

namespace PeriDeal
{
  /** The outward normal of a segment or triangle, as long as this is large. */
  dealii::Tensor<1, 2> area_vector(const std::array<dealii::Point<2>, 2> &corners);
  dealii::Tensor<1, 3> area_vector(const std::array<dealii::Point<3>, 3> &corners);


  /** A segment (2D) or triangle (3D) of the boundary of a mesh. */
  template <int dim>
  struct BoundaryFacet
  {
    std::array<dealii::types::global_dof_index, dim> nodes; // corners, or vertices of cells
    std::array<dealii::Point<dim>, dim>              corners;
    dealii::Tensor<1, dim>                           normal; // outwards
    double                                           area;
    dealii::types::boundary_id                       side;

    /** Weights of the corners in the point of it that is nearest to p. */
    std::array<double, dim> nearest_weights(const dealii::Point<dim> &p) const;

    dealii::Point<dim> at(const std::array<double, dim> &weights) const;
  };

  /**
   * All of the boundary, on each process, in an order that does not depend on who owns what; with
   * nodes where they are those of vertices. Collective.
   */
  template <int dim>
  std::vector<BoundaryFacet<dim>> gather_boundary_facets(
    const dealii::DoFHandler<dim> &dof_handler);

  /** Numbers of facets, so that visit_near() finds all that come within the reach of a point. */
  template <int dim, typename Facet>
  PointBins<dim> bins_of_facets(const std::vector<Facet> &facets, const double reach)
  {
    double size = 0.; // of the largest
    for (const Facet &facet : facets)
      for (const dealii::Point<dim> &corner : facet.corners)
        size = std::max(size, corner.distance(facet.corners[0]));
    PointBins<dim> bins(reach + size);
    for (unsigned int f = 0; f < facets.size(); ++f)
      bins.add(facets[f].corners[0], f);
    return bins;
  }


  /**
   * Which of the owned nodes on vertices lie on a facet of the boundary that does not end at them,
   * of another piece of the mesh or of the other side of a crack. Collective.
   * @param tolerance distance from a facet that counts as none
   */
  template <int dim>
  std::vector<bool> nodes_on_other_facets(const dealii::DoFHandler<dim> &dof_handler,
                                          const double                   tolerance);
} // namespace PeriDeal
