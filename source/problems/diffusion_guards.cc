// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// What the guards of a run look for where something diffuses, and what brings it about.

#include <perideal/problems/diffusion_problem.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "guard_causes.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** Of given values, where nothing enters but through them and they are constant numbers. */
    template <int dim>
    std::optional<Extent> range_of_given(const Scene<dim> &scene, const Operator &op)
    {
      const Expression &source    = scene.initial_and_source.source;
      const auto       &transfers = scene.boundary_conditions.transfers;
      const auto       &given     = scene.boundary_conditions.dirichlet;
      if (given.empty() || !source.is_constant() || source.value(Point<dim>()) != 0. ||
          op.depends_on_time() ||
          !std::all_of(transfers.begin(), transfers.end(), [](const SurfaceTransfer &transfer) {
            return transfer.insulates();
          }))
        return {};
      Extent range{std::numeric_limits<double>::max(), -std::numeric_limits<double>::max(), true};
      for (const SideCondition &condition : given)
        {
          if (!condition.value.is_constant())
            return {};
          const double value = condition.value.value(Point<dim>());
          range.least        = std::min(range.least, value);
          range.most         = std::max(range.most, value);
        }
      return range;
    }
  } // namespace


  template <int dim>
  unsigned int DiffusionProblem<dim>::steps_between_looks() const
  {
    if (!stepper || growth.suspects())
      return 1;
    // A look reads the values once, a step of one application all of K.
    return stepper->name() == "euler" ? 10 : stepper->name() == "rk4" ? 3 : 1;
  }


  template <int dim>
  Trip DiffusionProblem<dim>::watch(const double t)
  {
    const PlaceOfNode place_of = place_of_nodes(*this);
    if (scene.time.steady)
      return extent_of(solution).finite ?
               Trip() :
               values_not_finite(solution, 1, place_of, this->field_name(), t);
    const auto before = op().n_applications();
    const auto given  = range_of_given(scene, op());
    const Trip trip   = growth.look(op(),
                                  solution,
                                  t,
                                  given ? &*given : nullptr,
                                  place_of,
                                  names_of(scene.general.physics).field);
    op().carry_over_applications(before - op().n_applications()); // a look is none of the run's
    return trip ? trip : step_too_small(*stepper, scene.time.end_time, t);
  }


  template <int dim>
  void DiffusionProblem<dim>::explain(Trip &trip)
  {
    if (trip.cause.empty() && stepper)
      trip.cause = cause_in_step(*stepper, op(), solution, trip);
    if (trip.cause.empty())
      trip.cause = cause_in_operator(op(), place_of_nodes(*this), trip);
  }


#define PERIDEAL_INSTANTIATE(dim)                                           \
  template unsigned int DiffusionProblem<dim>::steps_between_looks() const; \
  template Trip         DiffusionProblem<dim>::watch(const double);         \
  template void         DiffusionProblem<dim>::explain(Trip &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
