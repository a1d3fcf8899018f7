// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/bounding_box.h>
#include <deal.II/grid/tria.h>

#include <perideal/scene/scene.h>

#include <map>
#include <memory>
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

    std::unique_ptr<dealii::Triangulation<dim>> mesh; // on each process
    dealii::BoundingBox<dim>                    box;
    SidePoints<dim>                             sides;
    double                                      spacing = 0.; // edge of a cell of the mean size
    bool is_round    = false; // new vertices do not lie on straight lines between the old ones
    bool has_corners = false; // corners_of_body()
  };


  /** The sides of a box. Not collective. */
  template <int dim>
  SidePoints<dim> sides_of_box(const Scene<dim> &scene);
} // namespace PeriDeal
