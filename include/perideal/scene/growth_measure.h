// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/control.h>

namespace PeriDeal
{
  /** The largest force in a run, and the path of cracks: what bonds that break lead to. */
  constexpr AccuracyMeasure measure_of_strength = static_cast<AccuracyMeasure>(4);
  constexpr AccuracyMeasure measure_of_path     = static_cast<AccuracyMeasure>(5);

  inline bool measures_growth(const AccuracyControl &accuracy)
  {
    return accuracy.measure == measure_of_strength || accuracy.measure == measure_of_path;
  }
} // namespace PeriDeal
