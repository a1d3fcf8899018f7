// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <mpi.h>

#include <string>
#include <vector>

namespace PeriDeal
{
  /** Which maps of a scene are wanted. */
  struct StabilityOptions
  {
    std::string              scene;
    std::vector<std::string> overrides;    // "Section/Entry=value", of all points
    std::string              maps;         // names with commas between them; empty: all that apply
    std::string              output;       // empty: output/studies/<scene>_stability
    unsigned int             n_random = 0; // points inside, and as many outside, of safe regions
    unsigned int             seed     = 1;
    bool                     quick    = false; // few points of each map
    bool                     quiet    = false; // print nothing but errors
  };


  /**
   * Find out where a scene, on a lattice coarse enough to be computed a thousand times, is computed
   * well and where not: each map varies what decides on that, and has for each point what the
   * program says beforehand (predicted), what a computation finds (observed), and a verdict.
   * `stability.csv` and `stability.json` in the output directory.
   *
   * Maps that a scene cannot have are named with the reason. Throws UserError: unknown maps, none
   * of those wanted can be had, or one of them has no points, which it says when all have been
   * computed. Collective.
   */
  void run_stability(const StabilityOptions &options, const MPI_Comm communicator);
} // namespace PeriDeal
