// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/problems/diffusion_problem.h>
#include <perideal/problems/run_context.h>
#include <perideal/scene/expression.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "problem_parts.h"

namespace PeriDeal
{
  using namespace dealii;

  using json = nlohmann::ordered_json;

  namespace
  {
    /**
     * What a box or an image, voids included, conducts as a whole: heat times length over area and
     * difference of temperature, if two opposite sides are held at different constant values and
     * all others are insulated or symmetry planes. The heat is the mean of what enters at one side
     * and leaves at the other, which is the same in the steady state only: the caller asks whether
     * it is.
     */
    template <int dim>
    std::optional<double> effective_conductivity(const Scene<dim> &scene, const Balance &balance)
    {
      const BoundaryConditions<dim> &bc = scene.boundary_conditions;
      if ((scene.domain.shape != Shape::box && scene.domain.shape != Shape::image) ||
          bc.dirichlet.size() != 2 || !is_zero(scene.initial_and_source.source) ||
          !std::all_of(bc.transfers.begin(), bc.transfers.end(), [](const SurfaceTransfer &side) {
            return side.insulates();
          }))
        return {};
      const SideCondition &a = bc.dirichlet[0], &b = bc.dirichlet[1];
      if (a.id >= 2 * dim || a.id / 2 != b.id / 2 || a.id == b.id || !a.value.is_constant() ||
          !b.value.is_constant())
        return {};
      const double difference = a.value.value(Point<dim>()) - b.value.value(Point<dim>());
      if (difference == 0.)
        return {};
      double length_over_area = 1.;
      for (unsigned int d = 0; d < dim; ++d)
        {
          const double length = scene.domain.extra.body_upper[d] - scene.domain.extra.body_lower[d];
          length_over_area = d == a.id / 2 ? length_over_area * length : length_over_area / length;
        }
      const double heat = 0.5 * (balance.sides.at(a.name) - balance.sides.at(b.name));
      return heat * length_over_area / difference;
    }


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
    bool is_steady(const DiffusionProblem<dim> &problem, const double throughput, const double t)
    {
      constexpr double negligible = 1e-3;
      if (problem.scene.time.steady)
        return true;
      Vector rate(problem.solution.get_partitioner());
      with_formulas(problem.dofs().get_communicator(),
                    [&] { problem.op().residual(rate, problem.solution, t); });
      return rate.l1_norm() <= negligible * throughput;
    }


    /** One sentence per side on what holds there. */
    template <int dim>
    json describe_sides(const Scene<dim> &scene)
    {
      const auto &conditions = scene.boundary_conditions;
      json        sides      = json::object();
      if (scene.domain.has_lattice())
        for (unsigned int k = 0; k < 2 * dim; ++k)
          sides[box_side_names()[k]] = "insulated";
      const auto add = [&](const std::string &name, const std::string &text) {
        json &side = sides[name];
        if (side.is_null() || side == "insulated")
          side = text;
        else if (text != "insulated")
          side = side.get<std::string>() + ", " + text;
      };
      for (const SideCondition &c : conditions.dirichlet)
        add(c.name, "Dirichlet " + c.value.text());
      for (const SurfaceTransfer &c : conditions.transfers)
        add(c.name, c.insulates() ? "insulated" : c.text());
      for (const auto side : conditions.symmetry)
        add(conditions.name_of(side), "symmetry");
      return sides;
    }


    /**
     * Flows and amounts of moisture are wetness times volume: nothing is given that would make
     * them masses.
     */
    bool counts_wetness(const Material &material)
    {
      const auto is_one = [](const MaterialProperty &property) {
        return property.is_constant() && property.value(Point<1>()) == 1.;
      };
      return is_one(material.density) && is_one(material.heat_capacity);
    }
  } // namespace


  template <int dim>
  nlohmann::ordered_json DiffusionProblem<dim>::add_since_start(const Balance     &balance,
                                                                const std::string &imbalance,
                                                                const double       t,
                                                                const RunContext  &context)
  {
    const std::string      &quantity = names_of(scene.general.physics).quantity;
    const CumulativeBalance since_start =
      ledger.balance(stepper->entered(), balance.content, this->dofs().get_communicator());
    ledger.keep(since_start,
                heat_apart(op(), solution, ledger.at_start()),
                balance.throughput(),
                t);
    const auto row = [&](const std::string &name, const double value) {
      context.record.add_row(this->name(), name, value, t);
    };
    row(quantity + " entered since start", since_start.entered);
    row(quantity + " stored since start", since_start.stored);
    row(imbalance, since_start.imbalance());
    return {{"entered", since_start.entered},
            {"stored", since_start.stored},
            {"imbalance", since_start.imbalance()},
            {"scale", ledger.most_moved()}};
  }


  template <int dim>
  void DiffusionProblem<dim>::add_totals_of_solid(const double t, const RunContext &context)
  {
    if (!stepper)
      return;
    Balance balance;
    with_formulas(this->dofs().get_communicator(),
                  [&] { balance = op().balance(solution, t, false); });
    const std::string &flow = names_of(scene.general.physics).flow;
    for (const auto &[side, value] : balance.sides)
      context.record.add_row(this->name(), flow + " through " + side, value, t);
    context.record.balances[this->name()]["heat balance"] = {
      {"throughput", balance.throughput()},
      {"cumulative", add_since_start(balance, "heat imbalance since start", t, context)}};
  }


  template <int dim>
  void DiffusionProblem<dim>::add_totals(const double t, const RunContext &context)
  {
    ResultRecord &record = context.record;
    Balance       balance;
    double        content = 0.;
    with_formulas(this->dofs().get_communicator(), [&] {
      balance = op().balance(solution, t, scene.time.steady);
      content = scene.general.physics == Physics::moisture ? body.weight(solution) :
                                                             balance.content;
    });
    const PhysicsNames &names = names_of(scene.general.physics);
    require_finite(
      {{"largest " + names.field, solution.linfty_norm()},
       {names.flow, balance.throughput()},
       {"imbalance", balance.imbalance()},
       {names.content, balance.content}},
      this->name(),
      t,
      "Numbers beyond 1e308 came up. Check the sizes and units of values, fluxes and sources (sections 'Boundary conditions' and 'Initial and source') and of the "
      "properties in section 'Material'.");
    const auto row = [&](const std::string &quantity, const double value) {
      record.add_row(this->name(), quantity, value, t);
    };
    row(names.content, content);
    for (const auto &[side, value] : balance.sides)
      row(names.flow + " through " + side, value);
    row(names.flow + " from sources", balance.sources);
    nlohmann::ordered_json cumulative; // not if steady
    row("rate of storage", balance.stored);
    row("throughput", balance.throughput());
    row("imbalance", balance.imbalance());
    if (stepper)
      cumulative = add_since_start(balance, "cumulative imbalance", t, context);
    for (std::size_t crack = 0; crack < balance.cracks.size(); ++crack)
      row(names.flow + " through crack " + std::to_string(crack + 1), balance.cracks[crack]);
    record.balances[this->name()] = {
      {"boundary flux", balance.sides},
      {"heat balance", {{"throughput", balance.throughput()}, {"imbalance", balance.imbalance()}}}};
    if (!cumulative.empty())
      record.balances[this->name()]["heat balance"]["cumulative"] = cumulative;
    if (const auto kappa = effective_conductivity(scene, balance);
        kappa && is_steady(*this, balance.throughput(), t))
      {
        row("effective conductivity", *kappa);
        record.balances[this->name()]["effective conductivity"] = *kappa;
      }
    if (!balance.cracks.empty())
      record.balances[this->name()]["crack flux"] = balance.cracks;
  }


  template <int dim>
  void DiffusionProblem<dim>::describe_scene(nlohmann::ordered_json &summary, const bool) const
  {
    if (scene.general.physics == Physics::moisture)
      summary["moisture counts"] = counts_wetness(scene.material) ? "wetness" : "mass";
    summary["sides"]     = describe_sides(scene);
    summary["reference"] = scene.reference.solution;
  }


  template <int dim>
  nlohmann::ordered_json DiffusionProblem<dim>::describe_solving() const
  {
    if (!stepper)
      return {{"stepper", "steady"}, {"steps", 0}, {"iterations", steady_iterations}};
    const Spectrum     spectrum = op().spectrum();
    const StepperCost &cost     = stepper->cost();
    json               entry    = {{"stepper", stepper->name()},
                                   {"steps", cost.steps},
                                   {"rejected steps", cost.rejected},
                                   {"iterations", cost.iterations}};
    if (cost.divided > 0)
      entry["divided steps"] = {{"number", cost.divided}, {"most parts", cost.most_parts}};
    if (stepper->current_step() > 0.)
      entry["time step"] = stepper->current_step();
    const std::string method = stepper->name() == "rk4" ? "rk4" : "euler";
    entry["stable step"]     = {{"sharp", stable_step(method, spectrum.sharp)},
                                {"safe", stable_step(method, spectrum.safe)},
                                {"method", method}};
    return entry;
  }


#define PERIDEAL_RESULTS(dim)                                                                      \
  template void DiffusionProblem<dim>::add_totals(const double, const RunContext &);               \
  template void DiffusionProblem<dim>::add_totals_of_solid(const double, const RunContext &);      \
  template void DiffusionProblem<dim>::describe_scene(nlohmann::ordered_json &, const bool) const; \
  template nlohmann::ordered_json DiffusionProblem<dim>::describe_solving() const;
  PERIDEAL_FOR_EACH_DIM(PERIDEAL_RESULTS)
#undef PERIDEAL_RESULTS
} // namespace PeriDeal
