// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/grid/tria.h>

#include <perideal/scene/phases.h>

namespace PeriDeal
{
  /**
   * Let regions given as `mesh(id)` know the material ids of the mesh. Asked for a point, they look
   * through the coarse cells, which every process has all of. Keeps a reference to the mesh.
   *
   * Throws UserError for an id that no cell has. Not collective.
   */
  template <int dim>
  void set_material_ids(const dealii::Triangulation<dim> &mesh, const Regions &regions);
} // namespace PeriDeal
