// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "guaranteed.h"

#include <perideal/analysis/energy_bound.h>
#include <perideal/base/instantiate.h>
#include <perideal/operators/diffusion/cell_term.h>
#include <perideal/problems/diffusion_problem.h>
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


  PERIDEAL_INSTANTIATE_FUNCTION(guaranteed_flow);
} // namespace PeriDeal
