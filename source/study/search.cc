// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "search.h"

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/memory.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "goal_estimate.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  Search<dim>::Search(const BodyOfChoice<dim>  &body,
                      const SceneText          &text,
                      const MPI_Comm            communicator,
                      const MeasuredError<dim> &measure,
                      const LimitOfAttempts     limit)
    : scene(*body.scene)
    , text(text)
    , communicator(communicator)
    , measure(measure)
    , family(body, limit)
  {}


  template <int dim>
  void Search<dim>::set(const std::vector<Setting> &of_all)
  {
    settings = of_all;
  }


  template <int dim>
  Attempt Search<dim>::with_settings(const double fineness) const
  {
    Attempt attempt = family.at(fineness);
    attempt.settings.insert(attempt.settings.end(), settings.begin(), settings.end());
    return attempt;
  }


  template <int dim>
  Attempt Search<dim>::first() const
  {
    return with_settings(family.coarsest());
  }


  template <int dim>
  Attempt Search<dim>::next(const double tolerance) const
  {
    constexpr double aim      = 0.7; // of the tolerance: an estimate is no bound
    const double     farthest = dim == 3 ? 2. : 3.;
    const double     last     = latest.attempt.fineness;
    double           wanted   = family.first_ratio() * last;
    if (few.predicted)
      wanted = fineness_for({*few.predicted, family.best_order()},
                            last,
                            aim * tolerance,
                            family.first_ratio());
    else if (n_compared() == 2)
      wanted = fineness_for({largest_error(steps), now.order},
                            last,
                            aim * tolerance,
                            family.first_ratio());
    else if (n_compared() > 2 && now.error > tolerance)
      wanted = fineness_for(now, last, aim * tolerance, farthest);
    // Rough places are seen unevenly: a third mesh that is barely finer shows no order.
    const bool   is_uneven   = n_compared() == 2 && family.best_order() <= 1.;
    const double least       = (is_uneven ? 1.3 : 1.1) * last;
    wanted                   = std::max(wanted, least);
    Attempt          attempt = with_settings(wanted);
    constexpr double most    = 100.; // of a given mesh there may be no finer one
    for (double more = least; attempt.fineness < least && more < most * least; more *= 1.1)
      attempt = with_settings(more);
    return attempt;
  }


  template <int dim>
  Tried<dim> Search<dim>::solve(const Attempt &attempt) const
  {
    using Clock         = std::chrono::steady_clock;
    const auto   start  = Clock::now();
    const double before = resident_memory();
    Tried<dim>   one;
    one.attempt                  = attempt;
    one.scene                    = scene_variant(scene, attempt.settings);
    one.scene->general.automatic = true;
    one.simulation   = std::make_unique<Simulation<dim>>(*one.scene, text, communicator, true);
    const bool grows = scene.accuracy.measures_growth();
    const bool many  = !scene.time.steady && scene.deforms && !grows; // numbers, at all times
    one.simulation->solve([&](const double t) {
      if (!scene.time.steady && !grows)
        one.seen.push_back(measure.see(one.simulation->problem(), one.scene->cracks));
      if (many)
        one.numbers.add(measure.numbers(*one.simulation, one.scene->cracks),
                        " at t = " + number_text(t));
    });
    if (!many)
      one.numbers = measure.numbers(*one.simulation, one.scene->cracks);
    one.cells = one.simulation->problem().dofs().get_triangulation().n_global_active_cells();
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    one.wall_time        = Utilities::MPI::max(seconds, communicator);
    one.memory = Utilities::MPI::sum(std::max(1e6, resident_memory() - before), communicator);
    return one;
  }


  template <int dim>
  void Search<dim>::compute(const Attempt &attempt)
  {
    Tried<dim> one = known ? std::move(*known) : solve(attempt);
    known.reset();
    const OfFew before = std::move(few);
    few                = {};
    std::optional<double> difference;
    if (n > 0)
      difference = measure.difference(one.solution(), latest.solution());
    latest = std::move(one);
    ++n;
    if (!difference) // the first of which anything is known
      steps.clear();
    steps.push_back({attempt.fineness, difference ? *difference : 0.});
    now = observed_error(steps, family.lowest_order(), family.best_order());
    // As if errors got smaller as slowly as cells, and half of that would do: no need of others.
    constexpr double careful = 2.;
    if (steps.size() == 2 && family.best_order() >= 2. && cubic_attempt(scene, attempt) &&
        careful * steps[1].difference <= scene.accuracy.tolerance)
      {
        now.error = steps[1].difference / std::min(1., steps[1].fineness / steps[0].fineness - 1.);
        few.are_enough = careful * now.error <= scene.accuracy.tolerance;
      }
    constexpr double part = 0.8;
    if (steps.size() == 2 && !few.are_enough && !before.of_cubic.values.empty() &&
        largest_error(steps) <= part * scene.accuracy.tolerance)
      if (const auto d = measure.difference(
            latest.solution(),
            {*latest.simulation, latest.scene->cracks, before.of_cubic, latest.seen}))
        {
          now.error      = std::max(smallest_error(), *d);
          few.are_enough = now.error <= scene.accuracy.tolerance;
        }
  }


  template <int dim>
  double Search<dim>::smallest_error() const
  {
    return steps[1].difference /
           (std::pow(steps[1].fineness / steps[0].fineness, family.best_order()) - 1.);
  }


  template <int dim>
  bool Search<dim>::asks_richer() const
  {
    const bool knows = scene.accuracy.measure == AccuracyMeasure::probes ||
                       !latest.numbers.values.empty(); // else the mesh is too coarse
    if (few.are_enough)
      return false;
    if (steps.size() == 1)
      return knows && !family.is_round() && family.best_order() >= 2. &&
             cubic_attempt(scene, latest.attempt);
    return steps.size() == 2 && family.best_order() >= 2. &&
           smallest_error() <= scene.accuracy.tolerance && cubic_attempt(scene, latest.attempt);
  }


  template <int dim>
  double Search<dim>::time_of_richer() const
  {
    return cost_of_cubic<dim>() * latest.wall_time;
  }


  template <int dim>
  double Search<dim>::memory_of_richer() const
  {
    return cost_of_cubic<dim>() * latest.memory;
  }


  template <int dim>
  void Search<dim>::ask_richer()
  {
    constexpr double alone  = 2.; // no other mesh is compared with
    const Tried<dim> richer = solve(*cubic_attempt(scene, latest.attempt));
    latest.estimate_time    = richer.wall_time;
    const auto d            = measure.difference(richer.solution(), latest.solution());
    if (!d)
      return;
    const double error = factor_of_cubic(scene) * *d;
    if (steps.size() == 2)
      now.error = std::max(smallest_error(), error);
    else
      {
        few.predicted = alone * error;
        few.of_cubic  = richer.numbers;
        if (*few.predicted > scene.accuracy.tolerance)
          return;
        now.error = *few.predicted;
      }
    few.are_enough = true;
  }


  template <int dim>
  Tried<dim> Search<dim>::release()
  {
    return std::move(latest);
  }


  template <int dim>
  bool Search<dim>::is_within(const double tolerance) const
  {
    constexpr double half = 0.5;
    if (now.error < 0. || now.error > tolerance)
      return false;
    if (steps.size() <= 2 && few.are_enough)
      return true;
    if (steps.size() == 2)
      {
        if (scene.accuracy.measure != AccuracyMeasure::field)
          return false;
        const double order = family.best_order();
        // As if an order that comes unevenly were half of what it is.
        return order > 1. ? largest_error(steps) <= tolerance :
                            steps[1].difference <=
                              half * tolerance *
                                (std::pow(steps[1].fineness / steps[0].fineness, 0.5 * order) - 1.);
      }
    // A low order is that of something rough, which comes unevenly.
    constexpr double rough = 0.7, careful = 0.8;
    const bool       is_uneven = family.best_order() <= 1.;
    if ((is_uneven || now.order < rough * family.best_order()) && now.error > careful * tolerance)
      return false;
    return steps.size() > 3 || now.order > 0.5 * family.best_order();
  }


  template <int dim>
  double Search<dim>::hopeless_order(const double tolerance) const
  {
    constexpr double       most = 1e5; // times what the last one took
    constexpr unsigned int few  = 3;
    if (n_compared() <= few || !(now.error > tolerance) || now.order >= 1.)
      return 0.;
    const double more = std::pow(now.error / tolerance, family.growth_of_cost() / now.order);
    return more > most ? now.order : 0.;
  }


  template <int dim>
  double Search<dim>::growth(const Attempt &attempt) const
  {
    return std::pow(attempt.fineness / latest.attempt.fineness, family.growth_of_cost());
  }


  template <int dim>
  double Search<dim>::expected_time(const Attempt &attempt) const
  {
    return latest.wall_time * growth(attempt);
  }


  template <int dim>
  double Search<dim>::expected_memory(const Attempt &attempt) const
  {
    return latest.memory * growth(attempt);
  }


  PERIDEAL_INSTANTIATE_CLASS(class Search);
} // namespace PeriDeal
