// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/boundary_facets.h>
#include <perideal/bonds/fictitious_extension.h>

#include <array>
#include <functional>
#include <vector>

namespace PeriDeal
{
  /** A fictitious node beyond the boundary of a mesh. */
  template <int dim>
  struct BoundaryImage
  {
    using Term = typename FictitiousExtension<dim>::Site::Term;

    dealii::Point<dim> place;
    double             volume;
    unsigned int       origin; // the node that it is an image of

    // What its displacement follows from; nodes that this process does not know are
    // numbers::invalid_unsigned_int.
    std::vector<Term>                           terms;
    std::vector<dealii::Point<dim>>             term_places;
    std::array<dealii::types::boundary_id, dim> planes; // of symmetry that it lies beyond, by axis
    dealii::Point<dim>                          twice_planes; // their coordinates, times 2
  };


  /**
   * How far from a node what its images follow from may lie, for families of a reach: what lies
   * farther has no bond.
   */
  double halo_of_images(const double reach);


  /**
   * Fictitious nodes beyond the boundary of a mesh, of any shape, for elastic bodies with nodes on
   * vertices. Each node m has an image through its nearest point p of each side within the reach,
   *
   *   x = 2 p - x_m,  u = 2 u(p) - u_m,  V = V_m a(d)/a(-d)
   *
   * with u(p) of the facet's nodes, and a(d) the area of the facet moved by the distance d of the
   * node along the normals of its vertices: beyond a hole images lie closer than nodes, and none
   * are beyond its middle. At convex edges one side after the other goes on. Images that are nearer
   * to another part of the boundary are left out. Beyond planes of symmetry all is mirrored. A node
   * on a side has images at its own place, the part of its volume that the body lacks there. Beyond
   * sides that do not go on there are none, and less volume where @p thin says so; in a reentrant
   * corner the others then fill their share.
   *
   * Those of the nodes that this process knows. Planes of symmetry are normal to an axis.
   * Collective.
   */
  template <int dim>
  std::vector<BoundaryImage<dim>> boundary_images(
    const Nodes<dim>                                            &nodes,
    const std::vector<dealii::types::boundary_id>               &symmetry,
    const std::function<bool(const dealii::types::boundary_id)> &goes_on,
    const double                                                 reach,
    ThinParts                                                   *thin = nullptr);
} // namespace PeriDeal
