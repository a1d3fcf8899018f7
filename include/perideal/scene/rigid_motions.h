// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <string>
#include <vector>

namespace PeriDeal
{
  template <int dim>
  struct Scene;

  /**
   * The rigid motions of an elastic body that no displacement and no symmetry plane holds:
   * "translation in x", "rotation about z" and so on.
   *
   * A side that holds a component of the displacement holds it at its corners (the hole: at points
   * around it). Each of these gives one row, the component of the dim translations and the
   * rotations there; what is free is the null space of all rows. Cracks that cut the body into
   * parts are not seen. Of a mesh file, whose sides lie wherever they do, only translations are
   * told, those in directions in which no side is held, and none if a side is a symmetry plane.
   */
  template <int dim>
  std::vector<std::string> free_rigid_motions(const Scene<dim> &scene);
} // namespace PeriDeal
