// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <string>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /**
   * Throws the UserError of the first of these values that is not finite: a result with infinities
   * or NaN must not pass for one.
   *
   * @param values name and value, causes before what follows from them; the same on all processes
   * @param remedy the entries whose sizes decide, as a sentence
   */
  void require_finite(const std::vector<std::pair<std::string, double>> &values,
                      const std::string                                 &model,
                      const double                                       t,
                      const std::string                                 &remedy);
} // namespace PeriDeal
