// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/progress.h>

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * What a run has found, from the summary at its end: how far models are apart, errors, stress
   * intensities, the largest force and the first broken bonds, effective conductivities; a line
   * each. Not collective.
   */
  std::vector<std::string> what_was_found(const nlohmann::ordered_json &summary);

  /**
   * The last lines of a run that is complete: what it has found, what it took, where the results
   * are, and what draws them. Not collective.
   */
  void say_what_was_found(const Progress               &progress,
                          const nlohmann::ordered_json &summary,
                          const std::string            &directory);
} // namespace PeriDeal
