// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/material.h>

#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * `User properties` of the body outside all phases, then of each phase; where a phase has none of
   * its own those of the body. Throws UserError.
   */
  std::vector<std::vector<double>> user_properties(const Material &material);
} // namespace PeriDeal
