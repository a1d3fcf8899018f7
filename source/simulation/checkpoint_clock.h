// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/control.h>

#include <mpi.h>

#include <chrono>
#include <string>

namespace PeriDeal
{
  /** When the state of a run is to be kept: by wall time, by its own time, where it has to stop. */
  class CheckpointClock
  {
  public:
    enum class Need
    {
      none,
      keep,
      stop // and keep
    };

    /** @param control is referred to */
    CheckpointClock(const CheckpointControl &control, const MPI_Comm communicator);

    /**
     * At a time of the run at which its state can be kept. Processes agree on that a few times a
     * second, however often this is asked. Collective.
     */
    Need need(const double t);

    /** The state has been kept; it took so many seconds on this process. Collective. */
    void kept(const double seconds);

    /** Why the run has to stop, as it goes after "by". */
    std::string reason() const;

    /** Seconds of wall time since this was made. */
    double elapsed() const;

  private:
    using Clock = std::chrono::steady_clock;

    const CheckpointControl &control;
    const MPI_Comm           communicator;
    const Clock::time_point  start;
    double                   last_kept = 0., last_look = 0., cost = 0.; // wall time
    bool                     out_of_time = false;
    double                   passed;                     // the last time of the run
    unsigned long long       n_asked = 0, n_between = 1; // since the last look
  };
} // namespace PeriDeal
