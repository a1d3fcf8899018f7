// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/diverged.h>
#include <perideal/scene/expression.h>
#include <perideal/solvers/step_span.h>

#include <functional>

namespace PeriDeal
{
  /**
   * with_formulas() of steps from a time on, which hand on the AfterStep that they are given. What
   * they throw as Diverged without a time has that of the last step before. Collective.
   */
  inline void steps_with_formulas(const MPI_Comm                                communicator,
                                  const double                                  from,
                                  const AfterStep                              &after_step,
                                  const std::function<void(const AfterStep &)> &steps)
  {
    double          now  = from;
    const AfterStep keep = [&](const double t) {
      now = t;
      if (after_step)
        after_step(t);
    };
    try
      {
        with_formulas(communicator, [&] { steps(keep); });
      }
    catch (Diverged &diverged)
      {
        if (diverged.trip.time < 0.)
          diverged.trip.time = now;
        throw;
      }
  }
} // namespace PeriDeal
