// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include "row_result.h"
#include "work_plan.h"

namespace PeriDeal
{
  /**
   * What a run has found at its last time: both components of the openings at the probes, which
   * stand right and left of cracks by turns, or both stress intensities at all ends. Nothing where
   * it has none. On rank 0 only.
   */
  std::vector<double> numbers_of(const RowResult   &result,
                                 const std::string &model,
                                 const WorkMeasure  measure);

  /** |a - b|/|b|, in the Euclidean norm. Throws UserError if they are not equally many. */
  double relative_difference(const std::vector<double> &a, const std::vector<double> &b);
} // namespace PeriDeal
