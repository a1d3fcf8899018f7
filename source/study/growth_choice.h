// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/output/result_folder.h>
#include <perideal/scene/scene.h>

namespace PeriDeal
{
  /**
   * `Models = auto` where the strength of a body at rest or the path of its cracks is measured.
   *
   * Without a horizon that is a length the converged body is Griffith's. Its cracks are followed
   * on coarse meshes of whole bodies (CrackTracer): for the strength, to find the cracks with which
   * it bears most, mostly those of the beginning, whose load is then found on ever finer meshes by
   * the stress intensities at their ends; for the path, in ever smaller steps.
   *
   * With such a horizon it is the nonlocal one: bonds that break on lattices with ever more nodes
   * in the horizon, and a straight line through what they say (lattice_fit.h).
   *
   * Throws UserError. Collective.
   */
  template <int dim>
  void run_growth(const Scene<dim> &scene,
                  const SceneText  &text,
                  const MPI_Comm    communicator,
                  const RunMode     mode,
                  const bool        quiet);

  /** Say what run_growth() would try. Collective. */
  template <int dim>
  void describe_growth(const Scene<dim> &scene,
                       const SceneText  &text,
                       const MPI_Comm    communicator,
                       const bool        quiet);
} // namespace PeriDeal
