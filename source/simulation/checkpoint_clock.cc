// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "checkpoint_clock.h"

#include <deal.II/base/mpi.h>

#include <perideal/base/process_end.h>
#include <perideal/base/step_break.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace PeriDeal
{
  using namespace dealii;

  CheckpointClock::CheckpointClock(const CheckpointControl &control, const MPI_Comm communicator)
    : control(control)
    , communicator(communicator)
    , start(Clock::now())
    , passed(-std::numeric_limits<double>::infinity())
  {}


  double CheckpointClock::elapsed() const
  {
    return std::chrono::duration<double>(Clock::now() - start).count();
  }


  CheckpointClock::Need CheckpointClock::need(const double t)
  {
    const bool passes = std::any_of(control.times.begin(),
                                    control.times.end(),
                                    [&](const double time) { return passed < time && time <= t; });
    passed            = t;
    ++n_asked;
    const bool was_left = step_was_left(); // that there is something to be done is known, then
    if (n_asked < n_between && !passes && !was_left)
      return Need::none;
    // What the first process finds by its clock holds for all; a signal may reach any.
    constexpr double    between_looks = 0.2, margin = 3.; // seconds; times the cost
    const double        now = elapsed();
    std::vector<double> own(3, 0.), all(3);
    own[0] = stop_requested() ? 1. : 0.;
    if (Utilities::MPI::this_mpi_process(communicator) == 0)
      {
        if (control.wall_time_limit > 0. &&
            now + margin * (cost + between_looks) >= control.wall_time_limit)
          own[0] = 2.;
        own[1] = control.every > 0. && now - last_kept >= control.every ? 1. : 0.;
        own[2] = std::floor(
          std::min(n_asked * between_looks / std::max(now - last_look, 1e-9), 2. * n_asked + 1.));
      }
    Utilities::MPI::max(own, communicator, all);
    n_between   = std::max(1., all[2]);
    n_asked     = 0;
    last_look   = now;
    out_of_time = all[0] > 1.;
    return all[0] > 0. ? Need::stop : all[1] > 0. || passes ? Need::keep : Need::none;
  }


  std::string CheckpointClock::reason() const
  {
    if (out_of_time)
      return "'Wall time limit' in section 'Checkpoint'";
    return stop_reason().empty() ? "a signal" : stop_reason();
  }


  void CheckpointClock::kept(const double seconds)
  {
    cost      = std::max(cost, seconds);
    last_kept = last_look = elapsed();
  }
} // namespace PeriDeal
