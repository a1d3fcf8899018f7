// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/scene.h>

namespace PeriDeal
{
  /**
   * What says that a scene can be computed: mesh and models find nothing that they cannot do.
   * Throws UserError, with its place in the text. Not collective.
   */
  template <int dim>
  void require_computable(const Scene<dim> &scene, const SceneText &text);

  /** parse_scene() and require_computable(): the scene is fine. Throws UserError. */
  template <int dim>
  void parse_computable(const SceneText &text, Scene<dim> &scene)
  {
    parse_scene(text, scene);
    if (!scene.general.automatic) // each model that is chosen says what it cannot compute
      require_computable(scene, text);
  }
} // namespace PeriDeal
