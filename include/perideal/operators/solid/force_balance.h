// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <map>
#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * The forces on a body at rest, each with one component for each direction (N; in 2D per unit
   * thickness).
   */
  struct ForceBalance
  {
    std::map<std::string, std::vector<double>> sides; // reactions and tractions, by the side's name
    std::vector<double>                        body;  // body forces

    /** Length of the sum of all. */
    double imbalance() const;

    /** Half the sum of the lengths of all: what passes through the body. */
    double throughput() const;
  };
} // namespace PeriDeal
