// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/problems/problem_cost.h>

#include <ctime>

namespace PeriDeal
{
  double processor_seconds()
  {
    return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
  }


  double time_of_application(const Operator &op)
  {
    Vector x, y;
    op.initialize_vector(x);
    op.initialize_vector(y);
    op.apply(y, x);
    constexpr unsigned int n_trials = 20;
    const double           start    = processor_seconds();
    for (unsigned int k = 0; k < n_trials; ++k)
      op.apply(y, x);
    return (processor_seconds() - start) / n_trials;
  }
} // namespace PeriDeal
