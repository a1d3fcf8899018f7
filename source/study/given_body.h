// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/bounding_box.h>
#include <deal.II/grid/tria.h>
#include <deal.II/numerics/rtree.h>

#include <perideal/scene/scene.h>

#include <functional>
#include <map>
#include <memory>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /** Some points of each side, by its number. Sides that meet share the points where they do. */
  template <int dim>
  using SidePoints = std::map<dealii::types::boundary_id, std::vector<dealii::Point<dim>>>;


  /** What the coarse mesh of a body that is no lattice shows of it. */
  template <int dim>
  struct GivenBody
  {
    /** Regions of the scene know the mesh afterwards. Throws UserError. Collective. */
    GivenBody(const Scene<dim> &scene, const MPI_Comm communicator);

    /** Whether a point lies in a coarse cell. Not collective. */
    bool contains(const dealii::Point<dim> &p) const;

    /**
     * How many cells along the longest edge of the box a function on a side needs: the fewest, of
     * the coarse ones or halves of these, on which its linear interpolant along edges of faces is
     * right to a fifth of its variation. Not collective.
     */
    double fineness_on_side(
      const dealii::types::boundary_id                         side,
      const std::function<double(const dealii::Point<dim> &)> &function) const;

    using CellBox = std::pair<dealii::BoundingBox<dim>,
                              typename dealii::Triangulation<dim>::active_cell_iterator>;

    std::unique_ptr<dealii::Triangulation<dim>> mesh; // on each process
    dealii::RTree<CellBox>                      cells;
    dealii::BoundingBox<dim>                    box;
    SidePoints<dim>                             sides;
    double                                      spacing = 0.; // edge of a cell of the mean size
    bool is_round        = false; // new vertices do not lie on straight lines between the old ones
    bool has_corners     = false; // corners_of_body()
    bool cracks_on_faces = false; // all that there are, so that the mesh can be cut there
  };


  /** The sides of a box. Not collective. */
  template <int dim>
  SidePoints<dim> sides_of_box(const Scene<dim> &scene);
} // namespace PeriDeal
