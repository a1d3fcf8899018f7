// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/user_error.h>
#include <perideal/scene/lists.h>
#include <perideal/simulation/estimate.h>
#include <perideal/simulation/model_run.h>
#include <perideal/solvers/static_solver.h>
#include <perideal/solvers/step_tools.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "elastic_fields.h"
#include "elastic_notes.h"
#include "elastic_phases.h"
#include "elastic_sides.h"
#include "elastic_summary.h"
#include "finite_results.h"
#include "scene_sample.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  std::vector<std::string> elastic_columns(const Scene<dim> &scene)
  {
    std::vector<std::string> columns;
    switch (dim)
      {
        case 1:
          columns = {"ux", "sxx", "von_mises"};
          break;
        case 2:
          columns = {"ux", "uy", "sxx", "syy", "szz", "sxy", "von_mises"};
          break;
        default:
          columns = {"ux", "uy", "uz", "sxx", "syy", "szz", "sxy", "sxz", "syz", "von_mises"};
      }
    if (scene.elasticity.computes_temperature)
      columns.push_back("temperature");
    return columns;
  }


  void append_row(const double                *displacement,
                  const SymmetricTensor<2, 3> &stress,
                  const unsigned int           dim,
                  std::vector<double>         &rows)
  {
    rows.insert(rows.end(), displacement, displacement + dim);
    rows.push_back(stress[0][0]);
    if (dim > 1)
      rows.insert(rows.end(), {stress[1][1], stress[2][2], stress[0][1]});
    if (dim > 2)
      rows.insert(rows.end(), {stress[0][2], stress[1][2]});
    rows.push_back(von_mises(stress));
  }


  template <int dim>
  ElasticRun<dim>::ElasticRun(const Scene<dim> &scene)
    : scene(scene)
  {}


  template <int dim>
  const Vector &ElasticRun<dim>::state() const
  {
    return displacement;
  }


  template <int dim>
  unsigned int ElasticRun<dim>::n_components() const
  {
    return dim;
  }


  template <int dim>
  std::vector<std::string> ElasticRun<dim>::columns() const
  {
    return elastic_columns(scene);
  }


  template <int dim>
  typename FieldWriter<dim>::Choice ElasticRun<dim>::shown() const
  {
    return [this](const Point<dim> &p) { return scene.domain.shows(p); };
  }


  namespace
  {
    /**
     * The temperature above the reference at the nodes of the elastic model. Both models have the
     * same element on the same mesh, but may number its nodes differently; each node has the same
     * owner in both.
     */
    template <int dim>
    void find_temperature_change(const ModelRun<dim>   &heat,
                                 const ElasticRun<dim> &elastic,
                                 const double           reference,
                                 Vector                &change)
    {
      const DoFHandler<dim> &from = heat.dofs(), &to = elastic.dofs();
      AssertDimension(from.get_fe().n_dofs_per_cell(), to.get_fe().n_dofs_per_cell());
      std::vector<types::global_dof_index> source(from.get_fe().n_dofs_per_cell()), target(source);
      const auto                          &owned = *change.get_partitioner();
      auto                                 cell  = to.begin_active();
      for (const auto &of_heat : from.active_cell_iterators())
        {
          if (cell->is_locally_owned())
            {
              of_heat->get_dof_indices(source);
              cell->get_dof_indices(target);
              for (unsigned int i = 0; i < source.size(); ++i)
                if (owned.in_local_range(target[i]))
                  change(target[i]) = heat.solution(source[i]) - reference;
            }
          ++cell;
        }
    }
  } // namespace


  template <int dim>
  void ElasticRun<dim>::take_temperature()
  {
    if (heat == nullptr)
      return;
    Timings::Scope scope(this->timings, "thermal loads");
    Vector         change;
    op().initialize_nodal_vector(change);
    find_temperature_change(*heat, *this, scene.elasticity.reference_temperature, change);
    op().set_temperature_change(change);
  }


  template <int dim>
  void ElasticRun<dim>::set_start()
  {
    const InitialAndSource &given = scene.initial_and_source;
    const auto              fill  = [&](Vector &vector, const std::vector<Expression> &formulas) {
      op().initialize_vector(vector);
      for (unsigned int i = 0; i < vector.locally_owned_size() && !formulas.empty(); ++i)
        vector.local_element(i) = formulas[i % dim].value(this->position(i / dim));
    };
    fill(displacement, given.initial_displacement);
    fill(velocity, given.initial_velocity);
    op().distribute(displacement, 0.);
    // Supports have the velocity of their first step.
    op().clear_constrained(velocity);
    AssertThrow(
      std::isfinite(displacement.l1_norm()) && std::isfinite(velocity.l1_norm()),
      UserError(
        "'Initial displacement' or 'Initial velocity' in section 'Initial and source' is not finite everywhere."));
  }


  template <int dim>
  StepperOptions ElasticRun<dim>::stepper_options() const
  {
    StepperOptions options;
    options.time_step        = scene.time.time_step;
    options.solver_tolerance = scene.solver.tolerance;
    options.max_iterations   = scene.solver.max_iterations;
    options.direct_up_to     = scene.solver.direct_up_to;
    return options;
  }


  template <int dim>
  void ElasticRun<dim>::begin_motion(const RunContext<dim> &context)
  {
    Timings::Scope scope(this->timings, "stepper");
    set_start();
    op().linearize(displacement);
    stepper     = make_motion_stepper(scene.time.stepper, op(), stepper_options());
    stable_step = stable_motion_step(op());
    std::ostringstream line;
    line << this->name() << ": stepper " << stepper->name() << ", step " << stepper->current_step()
         << ", "
         << readable_count(static_cast<unsigned long long>(
              std::ceil(scene.time.end_time / stepper->current_step() * (1. - 1e-10))))
         << " steps or a few more";
    context.progress.line(line.str());
  }


  template <int dim>
  void ElasticRun<dim>::begin(const RunContext<dim> &context)
  {
    if (!scene.elasticity.is_static())
      begin_motion(context);
  }


  template <int dim>
  void ElasticRun<dim>::settle(const RunContext<dim> &context)
  {
    if (!scene.elasticity.is_static())
      return;
    take_temperature();
    context.progress.doing("solving " + this->name());
    begin_loading(context);
    if (heat != nullptr && !scene.boundary_conditions.dirichlet.empty() && op().brittle() &&
        op().n_broken_bonds() > 0)
      context.record.notes.push_back(
        this->name() + ": " + readable_count(op().n_broken_bonds()) +
        " bonds broke at t = 0 already. 'Dirichlet' in section 'Boundary conditions' gives its sides their temperature at once, so that the outermost nodes "
        "are stretched against the next ones by all of the jump, however fine the lattice. 'Convection', or a 'Dirichlet' value that begins at the initial one, lets the heat in gradually.");
    if (scene.time.steady)
      context.progress.line(this->name() + ": " + std::to_string(n_iterations) + " iterations");
  }


  template <int dim>
  double ElasticRun<dim>::load_step() const
  {
    constexpr double share = 0.01; // of the end time, if no step is given
    if (scene.warms_slowly())      // `Time step` is that of the heat problem
      return (op().brittle() || op().nonlinear() ? share : 1.) * scene.time.end_time;
    return scene.time.time_step > 0. ? scene.time.time_step : share * scene.time.end_time;
  }


  template <int dim>
  std::vector<double> ElasticRun<dim>::stops(const double from, const double to) const
  {
    if (!loading)
      return {to};
    const unsigned long long n = n_equal_steps(to - from, load_step());
    std::vector<double>      times;
    for (unsigned long long k = 1; k < n; ++k)
      times.push_back(from + k * (to - from) / n);
    times.push_back(to);
    return times;
  }


  template <int dim>
  bool ElasticRun<dim>::tells_at_stops() const
  {
    return loading && !scene.time.steady;
  }


  template <int dim>
  std::string ElasticRun<dim>::doing(const unsigned int k,
                                     const unsigned int n,
                                     const double       t) const
  {
    if (!loading)
      return Problem<dim>::doing(k, n, t);
    return "solving " + this->name() + ", load step " + std::to_string(k) + " of " +
           std::to_string(n) + " until t = " + number_text(t);
  }


  template <int dim>
  void ElasticRun<dim>::advance(const double                             from,
                                const double                             to,
                                const std::function<void(const double)> &report,
                                const RunContext<dim>                   &context)
  {
    if (!loading)
      return move(from, to, report, context);
    if (scene.warms_slowly())
      take_temperature();
    Timings::Scope scope(this->timings, "solving");
    loading->step(displacement, to);
    n_iterations = loading->n_iterations();
    tell_first_break(*this, to, context);
  }


  template <int dim>
  void ElasticRun<dim>::move(const double                             from,
                             const double                             to,
                             const std::function<void(const double)> &report,
                             const RunContext<dim>                   &context)
  {
    constexpr unsigned int n_reports = 50; // of the progress
    Timings::Scope         scope(this->timings, "time stepping");
    // Whole steps between two reports, so that these change no step.
    const double       span = to - from, step = stepper->current_step();
    const double       n_steps = std::max(1., std::ceil(span / step * (1. - 1e-10)));
    const unsigned int n_parts = std::min(n_steps, static_cast<double>(n_reports));
    double             now     = from;
    for (unsigned int part = 1; part <= n_parts; ++part)
      {
        const double next =
          part == n_parts ? to : from + span * std::floor(n_steps * part / n_parts) / n_steps;
        stepper->advance(displacement, velocity, now, next);
        now = next;
        if (op().brittle())
          {
            tell_broken_bonds(op().n_broken_bonds());
            tell_first_break(*this, next, context);
          }
        report(static_cast<double>(part) / n_parts);
      }
  }


  template <int dim>
  double ElasticRun<dim>::work_of(const double span) const
  {
    if (!stepper)
      return 1.;
    const OperatorSize size = op().size();
    // A step costs about as much as the product with what is stored.
    return std::max(1., span / stepper->current_step()) *
           static_cast<double>(size.unknowns + size.nonzeros + size.bonds);
  }


  template <int dim>
  void ElasticRun<dim>::take_sample(const RunContext<dim> &, ModelEstimate &estimate)
  {
    op().initialize_vector(displacement);
    if (scene.elasticity.is_static())
      {
        if (scene.elasticity.solver == ElasticSolver::linear)
          estimate.time_of_solution =
            time_of_linear_equilibrium(scene.solver,
                                       op(),
                                       scene.time.steady ? 0. : scene.time.end_time,
                                       false);
        return;
      }
    // About as many steps as a run takes, whose first step is this one.
    const double step =
      make_motion_stepper(scene.time.stepper, op(), stepper_options())->current_step();
    estimate.applications = step > 0. ? scene.time.end_time / step : 0.;
  }


  template <int dim>
  double ElasticRun<dim>::time_of_run(const std::vector<double> &times,
                                      const bool,
                                      const RunContext<dim> &context,
                                      double                &memory)
  {
    if (!stepper)
      {
        const auto &models = scene.general.models;
        const auto  number = std::find_if(models.begin(), models.end(), [this](const auto kind) {
          return to_string(kind) == this->name();
        });
        return time_of_equilibria(
          scene,
          op(),
          number - models.begin(),
          scene.time.steady ? 1. : std::max(scene.time.end_time / load_step(), 1. * times.size()),
          this->dofs().get_communicator(),
          memory);
      }
    // By its first steps.
    const double step = stepper->current_step(), end = scene.time.end_time;
    const double from = std::min(step, end), to = std::min(4. * step, end);
    stepper->advance(displacement, velocity, 0., from);
    if (!(to > from))
      return 0.;
    const double before = context.progress.elapsed();
    stepper->advance(displacement, velocity, from, to);
    return (context.progress.elapsed() - before) * end / (to - from);
  }


  template <int dim>
  void ElasticRun<dim>::examine(const double t)
  {
    if (stepper)
      stepper->examine(displacement, velocity, t);
  }


  template <int dim>
  void ElasticRun<dim>::note_end(const RunContext<dim> &context) const
  {
    if (loading && !scene.time.steady)
      context.progress.line(this->name() + ": " + std::to_string(n_iterations) + " iterations");
    PeriDeal::note_end(*this, context);
  }


  template <int dim>
  void ElasticRun<dim>::begin_loading(const RunContext<dim> &context)
  {
    Timings::Scope scope(this->timings, "solving");
    StaticOptions  options;
    options.tolerance      = scene.solver.tolerance;
    options.max_iterations = scene.solver.most_iterations(scene.elasticity.solver);
    options.direct_up_to   = scene.solver.direct_up_to;
    options.multigrid      = scene.elasticity.multigrid;
    loading                = std::make_unique<SlowLoading>(
      op(),
      make_static_solver(scene.elasticity.solver_name(), op(), options),
      options);
    loading->begin(displacement, 0.);
    n_iterations = loading->n_iterations();
    tell_first_break(*this, 0., context);
  }


  template <int dim>
  nlohmann::ordered_json ElasticRun<dim>::describe_solving() const
  {
    nlohmann::ordered_json entry{{"iterations", n_iterations}};
    if (stepper)
      {
        entry["stepper"]     = stepper->name();
        entry["steps"]       = stepper->cost().steps;
        entry["iterations"]  = stepper->cost().iterations;
        entry["time step"]   = stepper->current_step();
        entry["stable step"] = {{"sharp", stable_step}, {"method", "verlet"}};
      }
    if (loading && !scene.time.steady)
      {
        entry["steps"] = loading->n_steps();
        if (!scene.warms_slowly()) // then equilibria are at times of output
          entry["time step"] = load_step();
      }
    return entry;
  }


  template <int dim>
  void ElasticRun<dim>::add_totals(const double t, const RunContext<dim> &context)
  {
    const auto row = [&](const std::string &quantity, const double value) {
      context.output.add_row(this->name(), quantity, value, t);
    };
    const ForceBalance          balance = op().forces(displacement, t);
    const double                energy  = op().energy(displacement);
    const SymmetricTensor<2, 3> mean    = mean_stress();
    require_finite(
      {{"largest displacement", displacement.linfty_norm()},
       {"strain energy", energy},
       {"sum of the forces", balance.throughput()},
       {"mean stress", von_mises(mean)}},
      this->name(),
      t,
      "Numbers beyond 1e308 came up. Check the sizes and units of loads and displacements (sections 'Boundary conditions' and 'Initial and source') and of the "
      "moduli (section 'Material').");
    row("strain energy", energy);
    for (const auto &[side, force] : balance.sides)
      for (unsigned int d = 0; d < dim; ++d)
        row("force on " + side + " in " + "xyz"[d], force[d]);
    if (!scene.time.steady)
      for (const auto &[side, moved] : displacements_of_sides(*this, scene))
        for (unsigned int d = 0; d < dim; ++d)
          row("displacement of " + side + " in " + "xyz"[d], moved[d]);
    keep_largest_force(balance, t, context.record.extremes[this->name()]);
    context.progress.state(text_of_largest_force(balance));
    for (unsigned int d = 0; d < dim; ++d)
      row(std::string("body force in ") + "xyz"[d], balance.body[d]);
    row("throughput", balance.throughput());
    if (!stepper) // of a motion it is the rate of its momentum
      row("imbalance", balance.imbalance());
    nlohmann::ordered_json stress = nlohmann::ordered_json::object();
    for (unsigned int a = 0; a < 3; ++a)
      for (unsigned int b = a; b < 3; ++b)
        if (b < dim || (dim == 2 && a == 2))
          {
            const std::string name = std::string(1, "xyz"[a]) + "xyz"[b];
            row("mean stress " + name, mean[a][b]);
            stress[name] = mean[a][b];
          }
    stress["von mises"]         = von_mises(mean);
    nlohmann::ordered_json ends = nlohmann::ordered_json::object();
    for (const StressIntensity &end : stress_intensities(t))
      {
        row("J-integral at " + end.name, end.j);
        row("stress intensity I at " + end.name, end.mode_1);
        row("stress intensity II at " + end.name, end.mode_2);
        ends[end.name] = {{"J-integral", end.j}, {"I", end.mode_1}, {"II", end.mode_2}};
      }
    context.record.balances[this->name()] = {{"boundary force", balance.sides},
                                             {"strain energy", energy},
                                             {"mean stress", stress}};
    if (stepper || op().brittle() || (scene.is_loaded_slowly() && !scene.warms_slowly()))
      context.record.balances[this->name()]["energy balance"] = add_energies(t, context);
    if (!stepper)
      {
        force_scale = std::max(force_scale, find_force_scale(*this, scene, balance.throughput()));
        context.record.balances[this->name()]["force balance"] = {
          {"throughput", balance.throughput()},
          {"imbalance", balance.imbalance()},
          {"scale", force_scale}};
      }
    if (!ends.empty())
      context.record.balances[this->name()]["stress intensity"] = ends;
  }


  template <int dim>
  nlohmann::ordered_json ElasticRun<dim>::add_energies(const double           t,
                                                       const RunContext<dim> &context)
  {
    using json = nlohmann::ordered_json;
    json       balance;
    const auto add = [&](const std::string &key, const std::string &quantity, const double value) {
      balance[key] = value;
      context.output.add_row(this->name(), quantity, value, t);
    };
    const auto add_all = [&](const auto &energy, const double lost) {
      balance["strain"] = energy.strain;
      balance["start"]  = energy.start;
      add("work", "work of loads and supports", energy.work);
      if (op().brittle())
        {
          add("released", "energy released by broken bonds", op().released_energy());
          add("dissipated", "energy dissipated", lost);
          const auto n_broken = op().n_broken_bonds();
          add("broken bonds", "broken bonds", static_cast<double>(n_broken));
          if (json &kept = context.record.extremes[this->name()];
              n_broken > 0 && !kept.contains("first broken bonds"))
            kept["first broken bonds"] = t;
        }
      if (!scene.warms_slowly()) // what warming does to the strain energy is not followed
        add("imbalance", "energy imbalance", energy.imbalance());
    };
    if (stepper)
      {
        const MotionEnergy energy = stepper->energy(displacement, velocity);
        add("kinetic", "kinetic energy", energy.kinetic);
        add_all(energy, energy.released);
        add("drift", "energy drift", energy.drift);
      }
    else
      {
        const LoadingEnergy energy = loading->energy(displacement);
        add_all(energy, energy.dissipated);
      }
    return balance;
  }


  template <int dim>
  void ElasticRun<dim>::describe_end(nlohmann::ordered_json &entry, ResultRecord &record) const
  {
    if (const auto phases =
          describe_phases(*this, scene, record.totals, this->dofs().get_communicator());
        !phases.empty())
      entry["phases"] = phases;
  }


  template <int dim>
  void ElasticRun<dim>::describe_scene(nlohmann::ordered_json &summary, const bool at_the_end) const
  {
    using json        = nlohmann::ordered_json;
    summary["solver"] = scene.elasticity.solver_name();
    summary["sides"]  = describe_elastic_sides(scene);
    Point<dim> lower = scene.domain.lower, upper = scene.domain.upper;
    for (unsigned int d = 0; d < dim && !scene.domain.has_extra_layers(); ++d)
      {
        lower[d] = summary["domain"]["lower"][d];
        upper[d] = summary["domain"]["upper"][d];
      }
    summary["values on sides"] = values_on_sides(scene,
                                                 lower,
                                                 upper,
                                                 scene.time.steady ? 0. : scene.time.end_time,
                                                 summary.value("places", json::object()));
    if (const std::string reason = no_stress_intensity(scene, summary["models"]);
        at_the_end && !reason.empty())
      summary["no stress intensity"] = reason;
  }


  template <int dim>
  std::unique_ptr<ElasticRun<dim>> make_elastic_run(const ModelKind           model,
                                                    const Triangulation<dim> &mesh,
                                                    const Scene<dim>         &scene)
  {
    // With fictitious nodes peridynamics is the coupled model without elements.
    return model == ModelKind::peridynamics && !scene.peridynamics.completes_families() ?
             make_state_run(mesh, scene) :
             make_elastic_element_run(model, mesh, scene);
  }


#define PERIDEAL_INSTANTIATE(dim)                                                        \
  template class ElasticRun<dim>;                                                        \
  template std::vector<std::string>         elastic_columns(const Scene<dim> &);         \
  template std::unique_ptr<ElasticRun<dim>> make_elastic_run(const ModelKind,            \
                                                             const Triangulation<dim> &, \
                                                             const Scene<dim> &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
