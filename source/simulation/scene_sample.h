// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/simulation/estimate.h>

#include <memory>
#include <vector>

namespace PeriDeal
{
  /** What a scene takes on a lattice that is coarse enough to be built in a second. */
  struct Sample
  {
    double                     cells = 0., nodes = 0.; // of the lattice, vertices
    double                     memory = 0., time_to_build = 0.;
    std::vector<ModelEstimate> models;
  };


  /** Cells of a lattice with @p more = 0, its vertices with 1. */
  template <int dim>
  double number_of(const std::array<unsigned int, dim> &cells, const unsigned int more);

  /**
   * Numbers of cells that are those of the scene divided by a whole number, if possible without
   * remainder, with about so many nodes.
   */
  template <int dim>
  std::array<unsigned int, dim> coarse_cells(const std::array<unsigned int, dim> &cells,
                                             const double                         nodes);

  /**
   * The scene on a coarser lattice with the same horizon in terms of its spacing, without points of
   * output. Throws UserError if it cannot be, for instance since cracks do not lie on its faces.
   */
  template <int dim>
  std::shared_ptr<Scene<dim>> coarse_scene(const Scene<dim>                    &scene,
                                           const std::array<unsigned int, dim> &cells);

  /** Build the scene, and solve what is linear, to see what that takes. Throws UserError.
   * Collective. */
  template <int dim>
  Sample take_sample(const Scene<dim> &scene, const MPI_Comm communicator);
} // namespace PeriDeal
