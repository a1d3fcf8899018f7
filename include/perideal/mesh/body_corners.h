// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/grid/tria.h>

#include <perideal/scene/scene.h>

#include <vector>

namespace PeriDeal
{
  /**
   * Where the solution of a body is rough whatever the formulas of the scene: corners that open to
   * more than 200 degrees inside, ends of faces that were cut apart among them, and, on a smooth
   * side, places where a given value or displacement ends, and where sides that meet have other
   * values. In two dimensions points, in three edges
   * of coarse cells by their two ends. Round sides have no corners. None in one dimension.
   * @param mesh its coarse cells are looked at, which every process has all of. Not collective.
   */
  template <int dim>
  std::vector<std::vector<dealii::Point<dim>>> corners_of_body(
    const Scene<dim>                 &scene,
    const dealii::Triangulation<dim> &mesh);
} // namespace PeriDeal
