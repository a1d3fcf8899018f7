// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/scene.h>

#include <optional>
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
   * "21, 21 | 41, 41" taken apart. Throws UserError naming @p option: another form, a count of
   * zero, lattices that do not become finer in every direction, fewer than @p at_least of them.
   */
  std::vector<CellCounts> parse_ladder(const std::string &text,
                                       const std::string &option,
                                       const unsigned int dim,
                                       const std::size_t  at_least);

  /**
   * Up to @p n_rungs lattices, each about twice as fine as the one before, the last @p cells
   * itself; odd counts stay odd and even ones even, since a row of nodes on a crack makes another
   * discretisation than none. None has fewer than eight cells in a direction.
   */
  std::vector<CellCounts> default_ladder(const CellCounts &cells, const unsigned int n_rungs);

  /**
   * Whether every crack can lie on faces of a lattice: all its edges run along the axes, and in 3D
   * it is normal to one.
   */
  bool along_axes(const CrackedBox &box);

  /** Whether the corners of all cracks lie on planes of a lattice of n cells in this direction. */
  bool corners_on_planes(const CrackedBox &box, const unsigned int direction, const unsigned int n);

  /**
   * The counts nearest to @p cells, the smaller of two, that are divisible by @p multiple and, with
   * @p on_faces, put all corners of all cracks on vertices of the lattice of cells so many times as
   * large; beyond the box a crack may end anywhere. None if there is none within a fifth of a
   * count, or @p multiple, or two.
   */
  std::optional<CellCounts> nearest_fitting(const CrackedBox  &box,
                                            const CellCounts  &cells,
                                            const bool         on_faces,
                                            const unsigned int multiple);

  /**
   * About how many bonds peridynamics in the whole box has on this lattice at m = @p ratio: all
   * pairs of nodes nearer than the horizon and half a spacing, edges neglected.
   */
  double estimated_bonds(const CrackedBox &box, const CellCounts &cells, const double ratio);

  /**
   * sqrt(sum V (u - r)^2 / sum V r^2) over the vertices of a lattice, x fastest, V their share of
   * the cells around them. Without a reference that differs from zero the root of sum V u^2/sum V.
   * @param with_gaps what has no number in the reference does not count: an exact solution on a
   *                  crack, where it has two values
   */
  double nodal_error(const std::vector<double> &values,
                     const std::vector<double> &reference,
                     const CellCounts          &cells,
                     const bool                 with_gaps = false);
} // namespace PeriDeal
