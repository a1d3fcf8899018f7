// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/scene.h>

#include <string>
#include <vector>

namespace PeriDeal
{
  /** Numbers of cells, one per direction. */
  using CellCounts = std::vector<unsigned int>;

  /** "21, 21", as the entry `Cells` has it. */
  std::string to_text(const CellCounts &cells);

  /** "21 x 21". */
  std::string lattice_name(const CellCounts &cells);

  /** A box with cracks as plain numbers. */
  struct CrackedBox
  {
    std::vector<double>                           lower, upper;
    CellCounts                                    cells;
    std::vector<std::vector<std::vector<double>>> cracks; // crack, corner, coordinate

    unsigned int dim() const
    {
      return static_cast<unsigned int>(lower.size());
    }
  };

  /** The box of a scene, its lattice and its cracks as they are before they grow. */
  template <int dim>
  CrackedBox cracked_box(const Scene<dim> &scene);

  /**
   * Whether every crack can lie on faces of a lattice: all its edges run along the axes, and in 3D
   * it is normal to one.
   */
  bool along_axes(const CrackedBox &box);

  /** Whether the corners of all cracks lie on planes of a lattice of n cells in this direction. */
  bool corners_on_planes(const CrackedBox &box, const unsigned int direction, const unsigned int n);
} // namespace PeriDeal
