// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/scene.h>

#include <string>

namespace PeriDeal
{
  /**
   * What programs that plan runs of a scene have to know of it, as JSON: title, dimension, the box
   * with its cells, the corners of its cracks as they are before they grow, whether it deforms and
   * is steady, what it is compared with, and why `Models = auto` does not choose for it, if it does
   * not (doc/python.md). Not collective.
   */
  template <int dim>
  std::string scene_facts(const Scene<dim> &scene);
} // namespace PeriDeal
