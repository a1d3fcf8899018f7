// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <mpi.h>

#include <functional>
#include <vector>

namespace PeriDeal
{
  /**
   * How many steps a run takes and how long they take, from its first ones: where steps adapt to a
   * solution that nobody knows yet, and the material has to be found anew in each.
   */
  class StepForecast
  {
  public:
    /**
     * Let a run go from 0 towards its end for about a second of processor time. @param advance to
     * the end, calling what it is given after each step but the last. Collective.
     */
    StepForecast(const double                                                            end,
                 const std::function<void(const std::function<void(const double t)> &)> &advance,
                 const MPI_Comm communicator);

    /** All of them. Those that were not tried grow as the later half of those that were, dt ~ t^p. */
    double n_steps() const;

    /** Of the steps over those that were tried. */
    double whole_over_tried() const
    {
      return n_steps() / static_cast<double>(times.size());
    }

    /** In processor time. */
    double seconds() const
    {
      return spent * whole_over_tried();
    }

  private:
    const double        end;
    std::vector<double> times; // after each step that was tried
    double              spent       = 0.;
    bool                is_complete = false;
  };
} // namespace PeriDeal
