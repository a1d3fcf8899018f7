// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <mpi.h>

#include <exception>

namespace PeriDeal
{
  /**
   * A step is left before its end, on all processes, since the run has been told to stop
   * (stop_requested()). Whoever has opened the LeavableStep puts back what the step has changed and
   * offers the state to be kept.
   */
  struct StepLeft : public std::exception
  {
    const char *what() const noexcept override
    {
      return "a step was left, since the run is to stop";
    }
  };


  /**
   * While it lives, leave_step_if_asked() may throw StepLeft: what has been done since can be
   * undone. On all processes or on none. (Where it is not open, a step goes on to its end.)
   */
  class LeavableStep
  {
  public:
    explicit LeavableStep(const bool can_be_undone);
    ~LeavableStep();
    LeavableStep(const LeavableStep &)            = delete;
    LeavableStep &operator=(const LeavableStep &) = delete;

  private:
    const bool before;
  };


  /**
   * To be called again and again by what may take seconds: iterations of solvers, stages of steps.
   * Throws StepLeft, on all processes, if a step that can be left is open and one of them has been
   * told to stop. They ask each other some five times a second, however often this is called.
   * Collective.
   */
  void leave_step_if_asked(const MPI_Comm communicator);

  /** Whether a step has been left since the last call. The same on all processes. */
  bool step_was_left();
} // namespace PeriDeal
