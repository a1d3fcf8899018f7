// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/elastic_operator.h>
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

  /** Of this process, so that other programs on the machine do not count. */
  double processor_seconds();

  /** In such seconds. Collective. */
  double time_of_application(const Operator &op);

  /**
   * Of one equilibrium; -1 where the solver does not get there: the run will say why. Throws
   * UserError, where it must be held, for a body with a part that nothing holds. Collective.
   */
  double time_of_linear_equilibrium(const SolverControlParameters &control,
                                    ElasticOperator               &op,
                                    const double                   t,
                                    const bool                     must_be_held);

  /**
   * Seconds that the equilibria of an elastic body take, negative if that is not known: a linear
   * one is solved, of a large body on a coarser lattice. Bonds that break take more. @param model
   * number of the model in the scene. @param n_steps of loading
   * @param memory raised to what the run of a large body takes at least beyond what is there before
   *               it. Collective.
   */
  template <int dim>
  double time_of_equilibria(const Scene<dim>  &scene,
                            ElasticOperator   &op,
                            const unsigned int model,
                            const double       n_steps,
                            const MPI_Comm     communicator,
                            double            &memory);
} // namespace PeriDeal
