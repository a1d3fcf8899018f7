// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/dofs/dof_handler.h>

#include <perideal/bonds/diffusion_bonds.h>
#include <perideal/scene/scene.h>
#include <perideal/solvers/stepper.h>

#include <string>
#include <vector>

namespace PeriDeal
{
  /*
   * Where methods for diffusion are known to fail (prm/failures), by numbers of the scene at hand.
   * An empty text: nothing to say.
   */

  /**
   * A source narrower than the cells falls between the points at which a mesh looks at it.
   * Collective.
   */
  template <int dim>
  void note_unseen_source(const Scene<dim>                 &scene,
                          const dealii::Triangulation<dim> &mesh,
                          std::vector<std::string>         &notes);

  /** A constant `Transmission` is another crack with each horizon. */
  template <int dim>
  void note_transmission(const Scene<dim> &scene, std::vector<std::string> &notes);

  /** Peridynamics without any need for it: the error of a wave as long as the body. */
  template <int dim>
  void note_smooth_field(const Scene<dim> &scene, std::vector<std::string> &notes);

  /**
   * Cells in which materials of different conductivity meet, and cells that cracks take away.
   * Collective.
   *
   * @param cut by the active index of cells
   */
  template <int dim>
  std::vector<std::string> notes_on_cells(const dealii::DoFHandler<dim> &dofs,
                                          const Scene<dim>              &scene,
                                          const std::vector<bool>       &cut);

  /**
   * What a body of bonds alone lacks along sides that cut families, or conducts too much or too
   * little between sides with given values; why it is of bonds alone, and what to do.
   */
  template <int dim>
  std::string note_on_cut_families(const Scene<dim> &scene, const KernelWeights<dim> &weights);

  /** The energy correction in one direction, beside cracks. Collective. */
  template <int dim>
  std::string note_on_one_direction(const Scene<dim> &scene, const DiffusionBonds<dim> &bonds);

  /** Fixed steps that do not damp what they do not resolve. */
  std::string note_on_fast_waves(const Stepper &stepper, const double end_time);

  /** Fixed steps that were divided, and into how many parts. */
  std::string note_on_divided_steps(const Stepper &stepper);
} // namespace PeriDeal
