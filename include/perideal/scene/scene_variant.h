// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/scene.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /** An entry as overrides name it, "Section/Entry" or "Entry", and its text. */
  using Setting = std::pair<std::string, std::string>;

  /**
   * A scene with the texts of another one but for some entries, parsed and checked. Both can live
   * on. Throws UserError.
   */
  template <int dim>
  std::shared_ptr<Scene<dim>> scene_variant(const Scene<dim>           &scene,
                                            const std::vector<Setting> &settings);
} // namespace PeriDeal
