// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/process_end.h>
#include <perideal/base/step_break.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace PeriDeal
{
  namespace
  {
    using Clock = std::chrono::steady_clock;

    bool               can_be_left = false, was_left = false;
    unsigned long long n_asked = 0, n_between = 1; // since all looked last
    Clock::time_point  last_look = Clock::now();
  } // namespace


  LeavableStep::LeavableStep(const bool can_be_undone)
    : before(std::exchange(can_be_left, can_be_undone))
  {}


  LeavableStep::~LeavableStep()
  {
    can_be_left = before;
  }


  void leave_step_if_asked(const MPI_Comm communicator)
  {
    if (!can_be_left || ++n_asked < n_between)
      return;
    // How many calls there are until the next look is what the fastest process finds.
    constexpr double between_looks = 0.2; // seconds
    const auto       now           = Clock::now();
    const double     passed        = std::chrono::duration<double>(now - last_look).count();
    const double     calls         = static_cast<double>(n_asked);
    const double     own[2]        = {
                 stop_requested() ? 1. : 0.,
      std::min(calls * between_looks / std::max(passed, 1e-9), 2. * calls + 1.)};
    double all[2];
    MPI_Allreduce(own, all, 2, MPI_DOUBLE, MPI_MAX, communicator);
    n_between = static_cast<unsigned long long>(std::max(1., std::floor(all[1])));
    n_asked   = 0;
    last_look = now;
    if (all[0] == 0.)
      return;
    was_left = true;
    throw StepLeft();
  }


  bool step_was_left()
  {
    return std::exchange(was_left, false);
  }
} // namespace PeriDeal
