// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/grid/tria.h>

#include <perideal/scene/scene.h>

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * Throws UserError for a condition of section `Boundary conditions`, of whatever physics, on a
   * side that the mesh does not have (the message names those that it has), and for what formulas
   * of sides may not give at the start (SurfaceTransfer::fault()). Collective.
   */
  template <int dim>
  void check_sides(const Scene<dim> &scene, const dealii::Triangulation<dim> &mesh);

  /**
   * Throws UserError for a point of `Parts` that lies farther outside the body than the cell next
   * to it is large, and appends a note for one that is outside, but nearer. Collective.
   */
  template <int dim>
  void check_points_of_parts(const Scene<dim>                 &scene,
                             const dealii::Triangulation<dim> &mesh,
                             std::vector<std::string>         &notes);

  /**
   * Where conditions hold that are not on a side of a box, for the sketch of the report: {name:
   * {"kind": "side" | "part of a side" |
   * "region" | "point", "lines": [[x0, y0, x1, y1], ...] (2D), "at": [[x, y], ...], "normals":
   * [[n_x, n_y], ...]}}. Lines are sides in straight
   * pieces; `at` are a few places spread over it, with the outward normals of a side. In one
   * dimension and off process 0 it is empty.
   * Collective.
   */
  template <int dim>
  nlohmann::ordered_json places_of_conditions(const Scene<dim>                 &scene,
                                              const dealii::Triangulation<dim> &mesh,
                                              const MPI_Comm                    communicator);
} // namespace PeriDeal
