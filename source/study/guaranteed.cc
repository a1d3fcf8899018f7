// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "guaranteed.h"

#include <perideal/analysis/elastic_bound.h>
#include <perideal/base/instantiate.h>
#include <perideal/operators/diffusion/cell_term.h>
#include <perideal/problems/diffusion_problem.h>
#include <perideal/problems/solid_problem.h>
#include <perideal/scene/lists.h>
#include <perideal/solvers/linear_solver.h>

namespace PeriDeal
{
  template <int dim>
  nlohmann::ordered_json guaranteed_flow(const Scene<dim> &scene, Simulation<dim> &simulation)
  {
    auto *const problem = dynamic_cast<const DiffusionProblem<dim> *>(&simulation.problem());
    if (problem == nullptr || !scene.time.steady ||
        scene.accuracy.measure != AccuracyMeasure::flow ||
        scene.general.models.front() != ModelKind::finite_elements ||
        !EnergyBounds<dim>::why_not(scene).empty())
      return {};
    const auto             &op = problem->op();
    LinearSolver            solver(op, scene.solver.tolerance, scene.solver.max_iterations);
    const EnergyBounds<dim> bounds(op, scene, [&](Vector &x, const Vector &b) {
      solver.solve(0., 1., x, b);
    });
    const FlowBound         flow = bounds.of_flow_through(scene.accuracy.side, problem->state());
    nlohmann::ordered_json  told = {{"lower", flow.lower}, {"upper", flow.upper}};
    if (!flow.reservation.empty())
      told["reservation"] = flow.reservation;
    return told;
  }


  template <int dim>
  nlohmann::ordered_json guaranteed_energy(const Scene<dim> &scene, Simulation<dim> &simulation)
  {
    if constexpr (dim == 1)
      return {};
    else
      {
        auto *const problem = dynamic_cast<const SolidProblem<dim> *>(&simulation.problem());
        if (problem == nullptr || scene.accuracy.text("Guaranteed energy") != "true" ||
            scene.general.models.front() != ModelKind::finite_elements ||
            problem->heat != nullptr || !ElasticBounds<dim>::why_not(scene).empty())
          return {};
        auto *const op = dynamic_cast<const ElasticElements<dim> *>(&problem->op());
        if (op == nullptr)
          return {};
        LinearSolver             solver(*op, scene.solver.tolerance, scene.solver.max_iterations);
        const ElasticBounds<dim> bounds(
          *op,
          problem->body.handler,
          scene,
          [&](Vector &x, const Vector &b) { solver.solve(0., 1., x, b); });
        const EnergyBound      bound = bounds.of(problem->displacement);
        nlohmann::ordered_json told  = {{"bound", bound.bound}, {"relative", bound.relative()}};
        if (!bound.reservation.empty())
          told["reservation"] = bound.reservation;
        return {{"energy", told}};
      }
  }


  std::string guaranteed_text(const nlohmann::ordered_json &told, const std::string &side)
  {
    if (told.contains("energy"))
      return "guaranteed: the error in energy is at most " +
             number_text(100. * told["energy"]["relative"].get<double>()) +
             " % of the displacement's";
    return "guaranteed: what enters through '" + side + "' lies between " +
           number_text(told["lower"].get<double>()) + " and " +
           number_text(told["upper"].get<double>());
  }


  PERIDEAL_INSTANTIATE_FUNCTION(guaranteed_flow);
  PERIDEAL_INSTANTIATE_FUNCTION(guaranteed_energy);
} // namespace PeriDeal
