// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/grid/tria.h>

#include <perideal/scene/scene.h>

#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * Throws UserError where conditions on parts meet others (looked for at quadrature points of
   * faces, for regions also at vertices) and neither can give way: two different values on two
   * parts, a value and a load in the same direction, two loads. Of a side and its part with values
   * the one named first holds. Collective.
   */
  template <int dim>
  void check_overlaps(const Scene<dim> &scene, const dealii::Triangulation<dim> &mesh);

  /**
   * Throws UserError for a condition of section `Boundary conditions`, of whatever physics, on a
   * side that the mesh does not have (the message names those that it has), and for a coefficient
   * of convection that is negative somewhere. Collective.
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
} // namespace PeriDeal
