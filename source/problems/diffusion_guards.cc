// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "diffusion_guards.h"

#include <perideal/problems/body_causes.h>
#include <perideal/problems/diffusion_problem.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

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
  DiffusionGuards<dim>::DiffusionGuards(DiffusionProblem<dim> &problem)
    : problem(problem)
  {}


  template <int dim>
  unsigned int DiffusionGuards<dim>::steps_between_looks() const
  {
    if (!problem.stepper || growth.suspects())
      return 1;
    // A look reads the values once, a step of one application all of K.
    const std::string name = problem.stepper->name();
    return name == "euler" ? 10 : name == "rk4" || name == "rkc2" ? 3 : 1;
  }


  template <int dim>
  Trip DiffusionGuards<dim>::watch(const double t)
  {
    const PlaceOfNode  place_of   = place_of_nodes(problem);
    const Scene<dim>  &scene      = problem.scene;
    DiffusionOperator &op         = problem.op();
    const auto         not_finite = [&]() {
      return extent_of(problem.solution).finite ?
                       Trip() :
                       values_not_finite(problem.solution, 1, place_of, problem.field_name(), t);
    };
    if (scene.time.steady)
      return not_finite();
    problem.ledger.see(problem.stepper->entered(), problem.dofs().get_communicator());
    const auto before = op.n_applications();
    const auto given  = range_of_given(scene, op);
    // What a solid releases beside bonds that break is as uneven as noise of the mesh, and grows
    // from load step to load step, though the steps of the heat problem are sound.
    const Trip trip = problem.heated_by_solid ? not_finite() :
                                                growth.look(op,
                                                            problem.solution,
                                                            t,
                                                            given ? &*given : nullptr,
                                                            place_of,
                                                            problem.field_name());
    op.carry_over_applications(before - op.n_applications()); // a look is none of the run's
    const Trip of_step = steps.look(*problem.stepper, scene.time.end_time, t);
    return trip ? trip : of_step;
  }


  template <int dim>
  Trip DiffusionGuards<dim>::watch_totals(const double t) const
  {
    const std::string &quantity = names_of(problem.scene.general.physics).quantity;
    return problem.stepper ? heat_lost(problem.op(), problem.ledger, quantity, t) : Trip();
  }


  template <int dim>
  void DiffusionGuards<dim>::explain(Trip &trip) const
  {
    if (trip.cause.empty() && trip.monitor == "balance")
      trip.cause = cause_in_balance(problem.scene.solver.tolerance);
    if (trip.cause.empty() && problem.stepper)
      trip.cause = cause_in_step(*problem.stepper, problem.op(), problem.solution, trip);
    const MaterialProperty &conductivity = problem.scene.material.conductivity;
    if (trip.cause.empty() && !conductivity.depends_on_temperature())
      trip.cause = cause_in_contrast<dim>(
        problem.dofs().get_triangulation(),
        "'Conductivity'",
        [&](const Point<dim> &p) { return conductivity.value(p); },
        trip.monitor);
    if (trip.cause.empty())
      trip.cause = cause_in_operator(problem.op(), place_of_nodes(problem), trip);
  }


  template class DiffusionGuards<1>;
  template class DiffusionGuards<2>;
  template class DiffusionGuards<3>;
} // namespace PeriDeal
