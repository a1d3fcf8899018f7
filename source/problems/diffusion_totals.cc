// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "diffusion_totals.h"

#include <perideal/problems/result_record.h>
#include <perideal/scene/expression.h>

#include <algorithm>
#include <cmath>

#include "effective_conductivity.h"
#include "finite_results.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /**
     * Heat that lies elsewhere than if that of the start were spread evenly, whatever the
     * temperature counts from; at least so much of all that there is that its round-off is small.
     * Collective.
     */
    double heat_apart(const Operator &op, const Vector &u, const double content_at_start)
    {
      constexpr double   least        = 1e-4;
      const Vector      &capacity     = op.lumped_capacity();
      const MPI_Comm     communicator = u.get_mpi_communicator();
      const unsigned int n            = u.locally_owned_size();
      double             whole        = 0.;
      for (unsigned int i = 0; i < n; ++i)
        whole += capacity.local_element(i);
      const double even  = content_at_start / Utilities::MPI::sum(whole, communicator);
      double       apart = 0., all = 0.;
      for (unsigned int i = 0; i < n; ++i)
        {
          apart += std::abs(capacity.local_element(i) * (u.local_element(i) - even));
          all += std::abs(capacity.local_element(i) * u.local_element(i));
        }
      return std::max(Utilities::MPI::sum(apart, communicator),
                      least * Utilities::MPI::sum(all, communicator));
    }


    /** Hardly any of the heat that passes changes the temperature anywhere. Collective. */
    template <int dim>
    bool is_steady(DiffusionProblem<dim> &problem, const double throughput, const double t)
    {
      constexpr double negligible = 1e-3;
      if (problem.scene.time.steady)
        return true;
      Vector rate(problem.solution.get_partitioner());
      with_formulas(problem.dofs().get_communicator(),
                    [&] { problem.op().residual(rate, problem.solution, t); });
      return rate.l1_norm() <= negligible * throughput;
    }


    /** Since the start; for the guards, too. @param imbalance the name of its row */
    template <int dim>
    nlohmann::ordered_json add_since_start(DiffusionProblem<dim> &problem,
                                           const Balance         &balance,
                                           const std::string     &imbalance,
                                           const double           t,
                                           const RunContext      &context)
    {
      const std::string      &quantity = names_of(problem.scene.general.physics).quantity;
      const CumulativeBalance since_start =
        problem.ledger.balance(problem.stepper->entered(),
                               balance.content,
                               problem.dofs().get_communicator());
      problem.ledger.keep(since_start,
                          heat_apart(problem.op(), problem.solution, problem.ledger.at_start()),
                          balance.throughput(),
                          t);
      const auto row = [&](const std::string &name, const double value) {
        context.record.add_row(problem.name(), name, value, t);
      };
      row(quantity + " entered since start", since_start.entered);
      row(quantity + " stored since start", since_start.stored);
      row(imbalance, since_start.imbalance());
      return {{"entered", since_start.entered},
              {"stored", since_start.stored},
              {"imbalance", since_start.imbalance()},
              {"scale", problem.ledger.most_moved()}};
    }
  } // namespace


  template <int dim>
  void add_heat_totals_of_solid(DiffusionProblem<dim> &heat,
                                const double           t,
                                const RunContext      &context)
  {
    if (!heat.stepper)
      return;
    Balance balance;
    with_formulas(heat.dofs().get_communicator(),
                  [&] { balance = heat.op().balance(heat.solution, t, false); });
    const std::string &flow = names_of(heat.scene.general.physics).flow;
    for (const auto &[side, value] : balance.sides)
      context.record.add_row(heat.name(), flow + " through " + side, value, t);
    context.record.balances[heat.name()]["heat balance"] = {
      {"throughput", balance.throughput()},
      {"cumulative", add_since_start(heat, balance, "heat imbalance since start", t, context)}};
  }


  template <int dim>
  void add_diffusion_totals(DiffusionProblem<dim> &problem,
                            const double           t,
                            const RunContext      &context)
  {
    ResultRecord &record = context.record;
    Balance       balance;
    double        content = 0.;
    with_formulas(problem.dofs().get_communicator(), [&] {
      balance = problem.op().balance(problem.solution, t, problem.scene.time.steady);
      content = problem.scene.general.physics == Physics::moisture ?
                  problem.weight(problem.solution) :
                  balance.content;
    });
    const PhysicsNames &names = names_of(problem.scene.general.physics);
    require_finite(
      {{"largest " + names.field, problem.solution.linfty_norm()},
       {names.flow, balance.throughput()},
       {"imbalance", balance.imbalance()},
       {names.content, balance.content}},
      problem.name(),
      t,
      "Numbers beyond 1e308 came up. Check the sizes and units of values, fluxes and sources (sections 'Boundary conditions' and 'Initial and source') and of the "
      "properties in section 'Material'.");
    const auto row = [&](const std::string &quantity, const double value) {
      record.add_row(problem.name(), quantity, value, t);
    };
    row(names.content, content);
    for (const auto &[side, value] : balance.sides)
      row(names.flow + " through " + side, value);
    row(names.flow + " from sources", balance.sources);
    nlohmann::ordered_json cumulative; // not if steady
    row("rate of storage", balance.stored);
    row("throughput", balance.throughput());
    row("imbalance", balance.imbalance());
    if (problem.stepper)
      cumulative = add_since_start(problem, balance, "cumulative imbalance", t, context);
    for (std::size_t crack = 0; crack < balance.cracks.size(); ++crack)
      row(names.flow + " through crack " + std::to_string(crack + 1), balance.cracks[crack]);
    record.balances[problem.name()] = {
      {"boundary flux", balance.sides},
      {"heat balance", {{"throughput", balance.throughput()}, {"imbalance", balance.imbalance()}}}};
    if (!cumulative.empty())
      record.balances[problem.name()]["heat balance"]["cumulative"] = cumulative;
    if (const auto kappa = effective_conductivity(problem.scene, balance);
        kappa && is_steady(problem, balance.throughput(), t))
      {
        row("effective conductivity", *kappa);
        record.balances[problem.name()]["effective conductivity"] = *kappa;
      }
    if (!balance.cracks.empty())
      record.balances[problem.name()]["crack flux"] = balance.cracks;
  }


  template void add_heat_totals_of_solid(DiffusionProblem<1> &, const double, const RunContext &);
  template void add_heat_totals_of_solid(DiffusionProblem<2> &, const double, const RunContext &);
  template void add_heat_totals_of_solid(DiffusionProblem<3> &, const double, const RunContext &);
  template void add_diffusion_totals(DiffusionProblem<1> &, const double, const RunContext &);
  template void add_diffusion_totals(DiffusionProblem<2> &, const double, const RunContext &);
  template void add_diffusion_totals(DiffusionProblem<3> &, const double, const RunContext &);
} // namespace PeriDeal
