// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/user_error.h>

#include <limits>
#include <string>
#include <vector>

namespace PeriDeal
{
  /** What has been found wrong with the state of a run. */
  struct Trip
  {
    std::string         monitor; // its name, as in summary.json; empty: nothing is wrong
    std::string         found;   // a sentence with the place, without a full stop
    double              value = std::numeric_limits<double>::quiet_NaN(), bound = value;
    std::vector<double> place;         // in the undeformed body; empty if there is none
    double              time    = -1.; // negative: not known
    unsigned long long  n_steps = 0;   // until then
    std::string         cause;         // sentences; empty: not known

    explicit operator bool() const
    {
      return !monitor.empty();
    }
  };


  /**
   * A run cannot go on: its state is none, or its equations could not be solved. An error of the
   * user's like others, for which summary.json has what was found.
   */
  class Diverged : public UserError
  {
  public:
    /** What a guard has found; not yet a message for the user. */
    explicit Diverged(const Trip &trip)
      : UserError(trip.found)
      , trip(trip)
      , of_guard(true)
    {}

    /** @param message all that the user is told */
    Diverged(const std::string &message, const Trip &trip)
      : UserError(message)
      , trip(trip)
    {}

    /** Where a solver has noticed by itself. @param message says what to do, too */
    Diverged(const std::string &message,
             const std::string &monitor,
             const double       value,
             const double       bound,
             const double       time = -1.)
      : UserError(message)
    {
      trip.monitor = monitor;
      trip.found   = message;
      trip.value   = value;
      trip.bound   = bound;
      trip.time    = time;
    }

    Trip trip;
    bool of_guard = false;
  };
} // namespace PeriDeal
