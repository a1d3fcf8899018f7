// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/problems/run_context.h>
#include <perideal/scene/scene.h>

#include <mpi.h>

#include <string>
#include <vector>

namespace PeriDeal
{
  /** What writing fields takes: seconds in all, and bytes at its peak. */
  struct OutputEstimate
  {
    double time = 0., memory = 0.;
  };

  /** @param components of the fields of each model (ModelEstimate::components). Not collective. */
  template <int dim>
  OutputEstimate estimate_output(const Scene<dim>          &scene,
                                 const double               cells,
                                 const std::vector<double> &components,
                                 const unsigned int         n_processes);

  /**
   * The last lines of `perideal check` of a scene that has been built: time and memory of a run.
   * @param computing in seconds, negative if it is not known. @param memory that the run needs at
   * least, in bytes. Collective.
   */
  template <int dim>
  std::vector<std::string> describe_costs(const Scene<dim>          &scene,
                                          const double               computing,
                                          const double               memory,
                                          const double               cells,
                                          const std::vector<double> &components,
                                          const MPI_Comm             communicator);

  /** What a run will need. Memory is what all processes together take at its peak beyond what they
   * have now, in bytes; times are of this number of processes, in seconds. */
  struct RunEstimate
  {
    double                     cells = 0., memory = 0., time_to_build = 0., time_of_output = 0.;
    std::vector<ModelEstimate> models;
    bool                       sampled = false;
    std::string                reason; // why it is not
  };


  /**
   * What a run of a scene needs, without building it: the body is built on two coarse lattices with
   * the same horizon in terms of the spacing, and what that takes is carried on as a n + b
   * n^((d-1)/d) for n nodes, since zones near cracks, and rims, grow as lines in 2D and as surfaces
   * in 3D. Where there are no such lattices (images, mesh files, cracks that have to lie on faces
   * of cells, horizons of so many nodes that no coarse lattice holds them) numbers of nodes and
   * full families alone say what is needed at least.
   *
   * The samples take a few seconds. Collective.
   */
  template <int dim>
  RunEstimate estimate_run(const Scene<dim> &scene, const MPI_Comm communicator);

  /**
   * What it says of one model. @param memory raised to what the run needs. Collective.
   */
  template <int dim>
  ModelEstimate estimate_model(const Scene<dim>  &scene,
                               const std::string &model,
                               const MPI_Comm     communicator,
                               double            &memory);

  /** The lines of `perideal check` about it, and whether it fits into what is available.
   * Collective. */
  std::vector<std::string> describe_estimate(const RunEstimate &estimate,
                                             const MPI_Comm     communicator);

  /** Whether building the scene to see what it needs takes long (above some 10 s), or may take more
   * than half of the memory available. Collective. */
  template <int dim>
  bool is_large(const Scene<dim> &scene, const MPI_Comm communicator);

  /**
   * Throw UserError if the scene needs more memory than is available; for those that are small
   * against it nothing is estimated. To be called before anything is built. Collective.
   */
  template <int dim>
  void require_memory(const Scene<dim> &scene, const MPI_Comm communicator);
} // namespace PeriDeal
