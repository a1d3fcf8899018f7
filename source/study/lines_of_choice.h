// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/study/cracked_box.h>

#include <optional>
#include <string>
#include <vector>

namespace PeriDeal
{
  /** Coordinates of lines (in 3D planes) between the cells of a box, for each direction. */
  using CellLines = std::vector<std::vector<double>>;

  /**
   * The fewest cells of a box, about as long as @p size or shorter, between which lie the corners
   * of cracks along the axes, points, and places for each direction; cells beside each other are at
   * most three times as long as one another. Nothing where two of these are so near to each other,
   * or to a side, that cells of their distance would not do.
   */
  std::optional<CellLines> lines_through(const CrackedBox &box,
                                         const CrackedBox &points,
                                         const CellLines  &places,
                                         const double      size);

  /** Each cell divided into n. */
  CellLines divided(const CellLines &lines, const unsigned int n);

  double n_cells(const CellLines &lines);

  /** As the entry `Cell lines` has it. */
  std::string to_text(const CellLines &lines);
} // namespace PeriDeal
