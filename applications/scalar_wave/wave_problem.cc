// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "wave_problem.h"

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/mesh/node_keys.h>
#include <perideal/problems/result_record.h>
#include <perideal/problems/run_context.h>
#include <perideal/scene/expression.h>
#include <perideal/scene/lists.h>

#include <cmath>

namespace ScalarWave
{
  using namespace dealii;
  using namespace PeriDeal;

  template <int dim>
  void WaveProblem<dim>::begin(const RunContext &)
  {
    AssertThrow(op().capacity_is_diagonal(),
                UserError("Waves need 'Capacity = lumped' in section 'Finite elements'."));
    op().initialize_vector(velocity);
    op().initialize_vector(acceleration);
    const double stable = 2. / std::sqrt(op().spectrum().sharp), given = scene.time.time_step;
    AssertThrow(given <= stable,
                UserError("'Time step' in section 'Time' is " + number_text(given) +
                          ", but waves of this mesh need at most " + number_text(stable) +
                          " (2/w of the fastest one). Choose a smaller one, or 'auto'."));
    constexpr double share = 0.5;
    longest_step           = given > 0. ? given : share * stable;
    accelerate(0.);
  }


  template <int dim>
  void WaveProblem<dim>::accelerate(const double t)
  {
    op().residual(acceleration, solution, t);
    for (unsigned int i = 0; i < acceleration.locally_owned_size(); ++i)
      acceleration.local_element(i) /= op().lumped_capacity().local_element(i);
  }


  template <int dim>
  void WaveProblem<dim>::advance(const double                             from,
                                 const double                             to,
                                 const std::function<void(const double)> &report,
                                 const RunContext                        &context)
  {
    Timings::Scope   scope(this->timings, "time stepping");
    constexpr double round_off = 1e-12;
    if (!span.is_open) // else the run has been stopped within it
      {
        span         = StepSpan::between(from, to);
        span.n_steps = static_cast<unsigned int>(
          std::max(1., std::ceil((to - from) / longest_step * (1. - round_off))));
      }
    const double dt = (span.end - span.start) / span.n_steps;
    while (span.n_done < span.n_steps)
      {
        ++span.n_done;
        ++n_steps;
        span.now = span.n_done == span.n_steps ? span.end : span.start + span.n_done * dt;
        velocity.add(0.5 * dt, acceleration);
        solution.add(dt, velocity);
        op().distribute(solution, span.now);
        accelerate(span.now);
        velocity.add(0.5 * dt, acceleration);
        report(static_cast<double>(span.n_done) / span.n_steps);
        if (context.after_step && span.n_done < span.n_steps)
          context.after_step(span.now);
      }
    span.is_open = false;
    AssertThrow(std::isfinite(velocity.linfty_norm()),
                UserError("The wave became unstable before t = " + number_text(to) +
                          ": choose a smaller 'Time step' in section 'Time'."));
  }


  template <int dim>
  void WaveProblem<dim>::exchange(Archive &archive)
  {
    const NodeKeys keys = node_keys(this->dofs());
    archive.exchange("displacement", solution, keys);
    archive.exchange("velocity", velocity, keys);
    archive.exchange("acceleration", acceleration, keys);
    archive.exchange("steps", n_steps);
    span.exchange(archive);
    op().exchange(archive, keys);
    this->timings.exchange(archive);
  }


  template <int dim>
  double WaveProblem<dim>::work_of(const double span) const
  {
    return span / longest_step * this->dofs().n_dofs();
  }


  template <int dim>
  void WaveProblem<dim>::add_totals(const double t, const RunContext &context)
  {
    double energies[2] = {0., 0.}; // u.(C a) = -u.(K u) where nothing acts from outside
    for (unsigned int i = 0; i < velocity.locally_owned_size(); ++i)
      {
        const double c = op().lumped_capacity().local_element(i), v = velocity.local_element(i);
        energies[0] += 0.5 * c * v * v;
        energies[1] -= 0.5 * c * solution.local_element(i) * acceleration.local_element(i);
      }
    for (double &energy : energies)
      energy = Utilities::MPI::sum(energy, this->dofs().get_communicator());
    context.record.add_row(this->name(), "kinetic energy", energies[0], t);
    context.record.add_row(this->name(), "potential energy", energies[1], t);
    context.record.add_row(this->name(), "energy", energies[0] + energies[1], t);
  }


  template <int dim>
  nlohmann::ordered_json WaveProblem<dim>::describe_solving() const
  {
    return {{"stepper", "central differences"}, {"steps", n_steps}, {"time step", longest_step}};
  }


  template <int dim>
  double WaveProblem<dim>::time_of_run(const std::vector<double> &,
                                       const bool,
                                       const RunContext &,
                                       double &)
  {
    return -1.;
  }


  template <int dim>
  void WaveProblem<dim>::take_sample(const RunContext &, ModelEstimate &)
  {}


  template <int dim>
  Trip WaveProblem<dim>::watch(const double t)
  {
    return Problem<dim>::watch(t);
  }


  template <int dim>
  std::vector<std::string> WaveProblem<dim>::notes() const
  {
    return {};
  }


  template <int dim>
  std::vector<OutputField> WaveProblem<dim>::fields(const double t) const
  {
    std::vector<OutputField> list = DiffusionProblem<dim>::fields(t);
    list.push_back({"velocity", {velocity}});
    list.back().components[0].update_ghost_values();
    return list;
  }


  template <int dim>
  void WaveFactory<dim>::require_computable(const Scene<dim> &scene) const
  {
    const auto require = [](const bool holds, const std::string &what) {
      AssertThrow(holds, UserError(what));
    };
    const auto &sides = scene.boundary_conditions;
    require(!scene.time.steady, "'Steady' in section 'Time': waves have no steady state.");
    require(scene.time.stepper == "auto",
            "'Stepper' in section 'Time' is '" + scene.time.stepper +
              "'; waves have their own, use 'auto'.");
    for (const SurfaceTransfer &transfer : sides.transfers)
      require(false,
              "Sides of waves are at rest ('Dirichlet', 0) or free: leave out '" +
                transfer.kind->entry + "'.");
    for (const SideCondition &side : sides.dirichlet)
      require(is_zero(side.value),
              "'Dirichlet' in section 'Boundary conditions': the side '" + side.name +
                "' of a wave is at rest, with 0, not '" + side.value.text() + "'.");
    require(is_zero(scene.initial_and_source.source),
            "'Source' in section 'Initial and source': nothing acts on these waves, use 0.");
    require(!scene.material.depends_on_temperature(),
            "Section 'Material': waves need properties that do not depend on T.");
    require(!scene.cracks.change(), "Section 'Cracks': waves need cracks that stay as they are.");
    require_diffusion(scene);
  }


  template <int dim>
  std::unique_ptr<Problem<dim>> WaveFactory<dim>::make_problem(Model<dim>       &model,
                                                               const Scene<dim> &scene) const
  {
    std::unique_ptr<DiffusionField<dim>> field;
    with_formulas(model.mesh.get_communicator(),
                  [&] { field = make_diffusion_field(model, scene); });
    return std::make_unique<WaveProblem<dim>>(std::move(field));
  }


  PERIDEAL_INSTANTIATE_CLASS(class WaveProblem);
  PERIDEAL_INSTANTIATE_CLASS(class WaveFactory);
} // namespace ScalarWave
