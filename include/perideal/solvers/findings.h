// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/diverged.h>

#include <cmath>
#include <deque>
#include <set>
#include <string>

namespace PeriDeal
{
  /**
   * What a solver finds wrong with states that it could go on from all the same: it ends the run,
   * or waits to be told (`Action = warn` in section `Guards`), the first of each monitor alone. Not
   * kept in checkpoints, before which all that waits has been told. Not collective: what is found
   * is the same on all processes.
   */
  class Findings
  {
  public:
    /** Else they end the run. */
    void let_wait()
    {
      wait = true;
    }

    bool may_wait() const
    {
      return wait;
    }

    /** It waits, or has been told: nothing needs to look for that again. */
    bool has(const std::string &monitor) const
    {
      return seen.count(monitor) > 0;
    }

    /**
     * Throws @p found, unless findings may wait and its value is a number: there is nothing to go
     * on with otherwise. @param n_steps until then
     */
    void add(const Diverged &found, const unsigned long long n_steps)
    {
      if (!wait || !std::isfinite(found.trip.value))
        throw found;
      if (!seen.insert(found.trip.monitor).second)
        return;
      waiting.push_back(found.trip);
      waiting.back().n_steps = n_steps;
    }

    /** The oldest of those that wait, which then does not any more; empty if there is none. */
    Trip take()
    {
      if (waiting.empty())
        return {};
      const Trip oldest = waiting.front();
      waiting.pop_front();
      return oldest;
    }

    /** Go on from those of another solver of the same run. */
    void carry_over(const Findings &before)
    {
      seen.insert(before.seen.begin(), before.seen.end());
      waiting.insert(waiting.begin(), before.waiting.begin(), before.waiting.end());
    }

  private:
    bool                  wait = false;
    std::set<std::string> seen; // monitors
    std::deque<Trip>      waiting;
  };
} // namespace PeriDeal
