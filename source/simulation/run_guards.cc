// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "run_guards.h"

#include <perideal/base/instantiate.h>
#include <perideal/scene/lists.h>

#include <cmath>

namespace PeriDeal
{
  namespace
  {
    const std::string no_cause =
      "None of the causes that are looked for was found: look at loads, given values and the material near that place and time";

    unsigned long long steps_of(const nlohmann::ordered_json &solving)
    {
      return solving.value("steps", 0ULL);
    }


    std::string with_full_stop(const std::string &text)
    {
      return text.empty() || text.back() == '.' ? text : text + ".";
    }


    template <int dim>
    std::string message_of(const Problem<dim> &problem, const bool steady, const Trip &trip)
    {
      const std::string when = ", t = " + number_text(trip.time) + ", after " +
                               std::to_string(trip.n_steps) +
                               (trip.n_steps == 1 ? " step" : " steps");
      return problem.name() + (steady ? "" : when) + ": " + with_full_stop(trip.found) +
             (trip.cause.empty() ? "" : " Cause: " + with_full_stop(trip.cause));
    }
  } // namespace


  template <int dim>
  RunGuards<dim>::RunGuards(const GuardControl &control,
                            const bool          steady,
                            const Progress     &progress,
                            ResultRecord       &record,
                            Timings            &timings)
    : control(control)
    , steady(steady)
    , progress(progress)
    , record(record)
    , timings(timings)
  {}


  template <int dim>
  bool RunGuards<dim>::are_on() const
  {
    return control.action != GuardAction::off;
  }


  template <int dim>
  void RunGuards<dim>::after_step(Problem<dim> &problem, const double t)
  {
    if (++n_steps < problem.steps_between_looks())
      return;
    n_steps = 0;
    look(problem, t);
  }


  template <int dim>
  void RunGuards<dim>::look(Problem<dim> &problem, const double t)
  {
    if (!are_on())
      return;
    Timings::Scope scope(timings, "guards");
    act_on_findings(problem);
    act_on(problem, problem.watch(t));
  }


  template <int dim>
  void RunGuards<dim>::act_on_findings(Problem<dim> &problem)
  {
    while (const Trip found = problem.take_finding())
      act_on(problem, found);
  }


  template <int dim>
  void RunGuards<dim>::act_on(const Problem<dim> &problem, Trip trip)
  {
    if (!trip)
      return;
    // Nothing can go on with what is no number. What a run goes on with keeps its material: the
    // cause, for which that is changed, is not looked for.
    if (control.action == GuardAction::stop || !std::isfinite(trip.value))
      throw Diverged(trip);
    nlohmann::ordered_json &told = record.warned[problem.name()];
    if (told.contains(trip.monitor))
      return;
    told[trip.monitor] = true;
    if (trip.n_steps == 0) // else a solver has found it some steps ago
      trip.n_steps = steps_of(problem.describe_solving());
    const std::string note = message_of(problem, steady, trip) +
                             " 'Action = stop' in section 'Guards' would have ended the run there.";
    progress.note(note);
    record.notes.push_back(note);
  }


  template <int dim>
  void RunGuards<dim>::look_at_totals(Problem<dim> &problem, const double t)
  {
    if (are_on())
      over(problem, t, [&] { act_on(problem, problem.watch_totals(t)); });
  }


  template <int dim>
  void RunGuards<dim>::examine(Problem<dim> &problem, const double t)
  {
    look(problem, t);
    problem.examine(t);
    if (are_on())
      act_on_findings(problem);
  }


  template <int dim>
  void RunGuards<dim>::over(Problem<dim>                &problem,
                            const double                 t,
                            const std::function<void()> &action)
  {
    try
      {
        action();
      }
    catch (const Diverged &diverged)
      {
        Trip trip    = diverged.trip;
        trip.n_steps = steps_of(problem.describe_solving());
        trip.time    = trip.time >= 0. ? trip.time : t;
        if (trip.monitor != "formulas") // which one process may have found alone
          problem.explain(trip);
        if (diverged.of_guard)
          {
            trip.cause = trip.cause.empty() ? no_cause : trip.cause;
            throw Diverged("The run was stopped: " + message_of(problem, steady, trip), trip);
          }
        if (trip.cause.empty() && trip.monitor == "formulas")
          trip.cause = trip.found;
        Trip told = trip;
        if (trip.cause == trip.found || trip.monitor == "time step")
          told.cause.clear();
        throw Diverged(message_of(problem, steady, told), trip);
      }
  }


  nlohmann::ordered_json describe_trip(const Trip &trip, const std::string &checkpoint)
  {
    nlohmann::ordered_json entry{{"monitor", trip.monitor},
                                 {"value", trip.value},
                                 {"bound", trip.bound},
                                 {"place", trip.place},
                                 {"time", trip.time},
                                 {"step", trip.n_steps},
                                 {"cause", trip.cause}};
    if (!checkpoint.empty())
      entry["checkpoint"] = checkpoint;
    return entry;
  }


  PERIDEAL_INSTANTIATE_CLASS(class RunGuards);
} // namespace PeriDeal
