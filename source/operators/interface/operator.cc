// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/operators/interface/operator.h>

#include <algorithm>

namespace PeriDeal
{
  double Balance::throughput() const
  {
    double sum = std::max(sources, 0.);
    for (const auto &[name, value] : sides)
      sum += std::max(value, 0.);
    return sum;
  }


  double Balance::imbalance() const
  {
    double sum = sources - stored;
    for (const auto &[name, value] : sides)
      sum += value;
    return sum;
  }
} // namespace PeriDeal
