// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/scene.h>

#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * Tell of `Surface correction = crack scaling` for diffusion around insulating cracks without it:
   * bonds and cut cells beside a crack conduct too little along it.
   */
  template <int dim>
  void note_missing_crack_scaling(const Scene<dim> &scene, std::vector<std::string> &notes);

  /** Tell in how many events cracks grow, if they do. */
  template <int dim>
  void note_growth(const Scene<dim> &scene, std::vector<std::string> &notes);
} // namespace PeriDeal
