// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/progress.h>
#include <perideal/problems/problem.h>
#include <perideal/problems/result_record.h>
#include <perideal/scene/guard_control.h>

#include <nlohmann/json.hpp>

#include <functional>
#include <set>
#include <string>
#include <utility>

namespace PeriDeal
{
  /**
   * The guards of a run: look at the states of its problems, and end it, or say so, where one is
   * none. Collective.
   */
  template <int dim>
  class RunGuards
  {
  public:
    /** All are referred to. */
    RunGuards(const GuardControl &control,
              const Progress     &progress,
              ResultRecord       &record,
              Timings            &timings);

    bool are_on() const;

    /** A step of this problem ends at t: look, if that is due. Throws Diverged. */
    void after_step(Problem<dim> &problem, const double t);

    /** Look now. Throws Diverged. */
    void look(Problem<dim> &problem, const double t);

    /**
     * Do it, and add to what it throws as Diverged what the problem knows of it: the message for
     * the user.
     */
    void over(Problem<dim> &problem, const double t, const std::function<void()> &action);

  private:
    const GuardControl                           &control;
    const Progress                               &progress;
    ResultRecord                                 &record;
    Timings                                      &timings;
    unsigned int                                  n_steps = 0; // since the last look
    std::set<std::pair<std::string, std::string>> told;        // problem and monitor, of `warn`
  };


  /** Of a trip in summary.json. @param checkpoint the last one; empty: none */
  nlohmann::ordered_json describe_trip(const Trip &trip, const std::string &checkpoint);
} // namespace PeriDeal
