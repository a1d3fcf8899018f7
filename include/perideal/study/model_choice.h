// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/output/result_folder.h>
#include <perideal/scene/scene.h>

namespace PeriDeal
{
  /**
   * Compute a scene with the models that it names. With `Models = auto`: try models and meshes from
   * cheap to dear until the estimated error is within the tolerance of section `Accuracy`, or the
   * budget is spent, and write the last one's results under the model name `auto`, with what was
   * tried as `accuracy` in summary.json (doc/choosing_a_model.md).
   *
   * Throws UserError, among others for scenes for which there is no choice yet. Collective.
   */
  template <int dim>
  void run_scene(const Scene<dim> &scene,
                 const SceneText  &text,
                 const MPI_Comm    communicator,
                 const RunMode     mode,
                 const bool        quiet);

  /** Say what run_scene() would try with `Models = auto`, and what that costs. Collective. */
  template <int dim>
  void describe_choice(const Scene<dim> &scene,
                       const SceneText  &text,
                       const MPI_Comm    communicator,
                       const bool        quiet);
} // namespace PeriDeal
