// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/progress.h>
#include <perideal/problems/problem.h>
#include <perideal/problems/result_record.h>
#include <perideal/scene/control.h>

#include <nlohmann/json.hpp>

#include <functional>
#include <string>

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
    /** All are referred to. @param steady nothing has a time */
    RunGuards(const GuardControl &control,
              const bool          steady,
              const Progress     &progress,
              ResultRecord       &record,
              Timings            &timings);

    bool are_on() const;

    /** A step of this problem ends at t: look, if that is due. Throws Diverged. */
    void after_step(Problem<dim> &problem, const double t);

    /** Look now, at what solvers have found by themselves first. Throws Diverged. */
    void look(Problem<dim> &problem, const double t);

    /** The problem has added its totals of t: look at their balances. Throws Diverged. */
    void look_at_totals(Problem<dim> &problem, const double t);

    /** Before results of a time are written: look, and have the problem examine its state. */
    void examine(Problem<dim> &problem, const double t);

    /**
     * Do it, and add to what it throws as Diverged what the problem knows of it: the message for
     * the user.
     */
    void over(Problem<dim> &problem, const double t, const std::function<void()> &action);

  private:
    /** Of solvers, which wait. */
    void act_on_findings(Problem<dim> &problem);

    /** What has been found ends the run, or becomes a note. */
    void act_on(const Problem<dim> &problem, Trip trip);

    const GuardControl &control;
    const bool          steady;
    const Progress     &progress;
    ResultRecord       &record;
    Timings            &timings;
    unsigned int        n_steps = 0; // since the last look
  };


  /** Of a trip in summary.json. @param checkpoint the last one; empty: none */
  nlohmann::ordered_json describe_trip(const Trip &trip, const std::string &checkpoint);
} // namespace PeriDeal
