// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <cstdint>

namespace PeriDeal
{
  /** At most so many cells at a time. */
  constexpr unsigned int n_cells_at_once = 64;

  /**
   * The squares |eps|^2 of strains at the centres of n cells that follow one another along a
   * lattice, compiled for several instruction sets.
   *
   * @param u       displacements of nodes, interleaved
   * @param corners of the first cell, the nodes of the others are shifted by one each; in 1, 2 or 3
   *                dimensions 2, 4 or 8
   * @param slopes  one over the number of corners on a side of a cell times its size
   */
  void find_strain_squares(const unsigned int   dim,
                           const double        *u,
                           const std::uint32_t *corners,
                           const double        *slopes,
                           const unsigned int   n,
                           double              *squares);
} // namespace PeriDeal
