// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Bodies in motion: from the initial displacement and velocity through the times of output.

#include <perideal/base/user_error.h>
#include <perideal/scene/lists.h>
#include <perideal/simulation/elastic_simulation.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "result_record.h"
#include "run_output.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void ElasticSimulation<dim>::set_start(ElasticRun<dim> &model) const
  {
    const InitialAndSource &given = scene.initial_and_source;
    const auto              fill  = [&](Vector &vector, const std::vector<Expression> &formulas) {
      model.op().initialize_vector(vector);
      for (unsigned int i = 0; i < vector.locally_owned_size() && !formulas.empty(); ++i)
        vector.local_element(i) = formulas[i % dim].value(model.position(i / dim));
    };
    fill(model.displacement, given.initial_displacement);
    fill(model.velocity, given.initial_velocity);
    model.op().distribute(model.displacement, 0.);
    // Supports have the velocity of their first step.
    model.op().clear_constrained(model.velocity);
    AssertThrow(
      std::isfinite(model.displacement.l1_norm()) && std::isfinite(model.velocity.l1_norm()),
      UserError(
        "'Initial displacement' or 'Initial velocity' in section 'Initial and source' is not finite everywhere."));
  }


  template <int dim>
  void ElasticSimulation<dim>::make_steppers()
  {
    StepperOptions options;
    options.time_step        = scene.time.time_step;
    options.solver_tolerance = scene.solver.tolerance;
    options.max_iterations   = scene.solver.max_iterations;
    options.direct_up_to     = scene.solver.direct_up_to;
    for (const auto &model : models)
      {
        Timings::Scope scope(model->timings, "stepper");
        set_start(*model);
        model->op().linearize(model->displacement);
        model->stepper     = make_motion_stepper(scene.time.stepper, model->op(), options);
        model->stable_step = stable_motion_step(model->op());
        std::ostringstream line;
        line << model->name() << ": stepper " << model->stepper->name() << ", step "
             << model->stepper->current_step() << ", "
             << readable_count(static_cast<unsigned long long>(
                  std::ceil(scene.time.end_time / model->stepper->current_step() * (1. - 1e-10))))
             << " steps or a few more";
        progress.line(line.str());
      }
  }


  template <int dim>
  double ElasticSimulation<dim>::share_of_models(const unsigned int n, const double span) const
  {
    double some = 0., all = 0.;
    for (unsigned int k = 0; k < models.size(); ++k)
      {
        const OperatorSize size = models[k]->op().size();
        // A step costs about as much as the product with what is stored.
        const double cost = std::max(1., span / models[k]->stepper->current_step()) *
                            static_cast<double>(size.unknowns + size.nonzeros + size.bonds);
        all += cost;
        if (k < n)
          some += cost;
      }
    return some / all;
  }


  template <int dim>
  void ElasticSimulation<dim>::move()
  {
    constexpr unsigned int n_reports = 50; // of the progress between two times of output
    progress.begin("time");
    if (scene.output.starts_at_zero())
      output->write_fields(0.);
    double now = 0.;
    for (const double t : times_of_output())
      {
        if (t > now)
          for (unsigned int k = 0; k < models.size(); ++k)
            {
              ElasticRun<dim> &model = *models[k];
              const double     done  = share_of_models(k, t - now),
                           more      = share_of_models(k + 1, t - now);
              const auto share       = [&](const double of_model) {
                return (now + (done + (more - done) * of_model) * (t - now)) / scene.time.end_time;
              };
              progress.doing(model.name() + ": time stepping");
              progress.advancing(now, t, share(0.), share(1.));
              Timings::Scope scope(model.timings, "time stepping");
              // Whole steps between two reports, so that these change no step.
              const double       span = t - now, step = model.stepper->current_step();
              const double       n_steps = std::max(1., std::ceil(span / step * (1. - 1e-10)));
              const unsigned int n_parts = std::min(n_steps, static_cast<double>(n_reports));
              double             from    = now;
              for (unsigned int part = 1; part <= n_parts; ++part)
                {
                  const double to = part == n_parts ?
                                      t :
                                      now + span * std::floor(n_steps * part / n_parts) / n_steps;
                  model.stepper->advance(model.displacement, model.velocity, from, to);
                  from = to;
                  if (model.op().brittle())
                    {
                      tell_broken_bonds(model.op().n_broken_bonds());
                      tell_first_break(model, to);
                    }
                  progress.update(share(static_cast<double>(part) / n_parts));
                }
            }
        now = t;
        for (const auto &model : models)
          model->stepper->examine(model->displacement, model->velocity, t);
        write_output(t);
      }
    progress.end();
    for (const auto &model : models)
      {
        note_steps(*model);
        note_energy(*model);
        note_inversion(*model);
        note_torn_sides(*model);
      }
  }


  template <int dim>
  void ElasticSimulation<dim>::note_steps(const ElasticRun<dim> &model)
  {
    const double first    = StepLimit::share * model.stable_step,
                 shortest = model.stepper->shortest_step();
    if (scene.time.time_step < 0. && model.stepper->name() == "verlet" && shortest < first)
      record->notes.push_back(model.name() +
                              ": the automatic time step followed the body's deformation, from " +
                              number_text(first) + " down to " + number_text(shortest) + ".");
  }


  template <int dim>
  void ElasticSimulation<dim>::note_energy(const ElasticRun<dim> &model)
  {
    constexpr double tolerable = 0.01,
                     few       = 0.01; // where few bonds have broken it is not they that tell
    const auto rounded         = [](const double x) {
      std::ostringstream text;
      text << std::setprecision(3) << x;
      return text.str();
    };
    const auto note = [&](const auto &energy, const double lost) {
      const double imbalance = energy.imbalance();
      const bool   of_bonds  = model.op().brittle() && lost > few * energy.exchanged;
      const double whole     = of_bonds ? lost : energy.exchanged;
      if (std::abs(imbalance) <= tolerable * whole)
        return;
      record->notes.push_back(
        model.name() + ": the energy balance does not close. What " +
        (imbalance < 0. ? "is missing" : "has come from nowhere") + " at the end, " +
        rounded(std::abs(imbalance)) + ", is " + rounded(100. * std::abs(imbalance) / whole) +
        " % of " +
        (of_bonds ? "what broken bonds have dissipated" : "what start and loads have brought in") +
        (model.stepper ?
           ". A smaller 'Time step' in section 'Time' makes it less: half the step a quarter, where it is not the breaking of bonds that makes it." :
           ". Smaller steps of the loading ('Time step' in section 'Time') make it less."));
    };
    if (model.stepper)
      {
        const MotionEnergy energy = model.stepper->energy(model.displacement, model.velocity);
        note(energy, energy.released);
      }
    else
      {
        const LoadingEnergy energy = model.loading->energy(model.displacement);
        note(energy, energy.dissipated);
      }
  }


  template <int dim>
  void ElasticSimulation<dim>::note_inversion(const ElasticRun<dim> &model)
  {
    if (model.op().nonlinear()) // such runs have ended
      return;
    const Inversion found = model.op().inverted(model.displacement);
    if (found.n_nodes > 0)
      record->notes.push_back(
        model.name() + ": the displacements turn cells inside out at " +
        std::to_string(found.n_nodes) + " nodes, worst at " + found.place +
        ". They are far beyond the small displacements that 'Kinematics = linear' in section 'Elasticity' is for: read them as those of a "
        "load of 1, in proportion to the load, or make the load smaller.");
  }


  template <int dim>
  nlohmann::ordered_json ElasticSimulation<dim>::add_energies(const ElasticRun<dim> &model,
                                                              const double           t)
  {
    using json = nlohmann::ordered_json;
    json       balance;
    const auto add = [&](const std::string &key, const std::string &quantity, const double value) {
      balance[key] = value;
      output->add_row(model.name(), quantity, value, t);
    };
    const auto add_all = [&](const auto &energy, const double lost) {
      balance["strain"] = energy.strain;
      balance["start"]  = energy.start;
      add("work", "work of loads and supports", energy.work);
      if (model.op().brittle())
        {
          add("released", "energy released by broken bonds", model.op().released_energy());
          add("dissipated", "energy dissipated", lost);
          const auto n_broken = model.op().n_broken_bonds();
          add("broken bonds", "broken bonds", static_cast<double>(n_broken));
          if (json &kept = record->extremes[model.name()];
              n_broken > 0 && !kept.contains("first broken bonds"))
            kept["first broken bonds"] = t;
        }
      if (!scene.warms_slowly()) // what warming does to the strain energy is not followed
        add("imbalance", "energy imbalance", energy.imbalance());
    };
    if (model.stepper)
      {
        const MotionEnergy energy = model.stepper->energy(model.displacement, model.velocity);
        add("kinetic", "kinetic energy", energy.kinetic);
        add_all(energy, energy.released);
        add("drift", "energy drift", energy.drift);
      }
    else
      {
        const LoadingEnergy energy = model.loading->energy(model.displacement);
        add_all(energy, energy.dissipated);
      }
    return balance;
  }


#define PERIDEAL_INSTANTIATE(dim)                                                                  \
  template void   ElasticSimulation<dim>::make_steppers();                                         \
  template double ElasticSimulation<dim>::share_of_models(const unsigned int, const double) const; \
  template void   ElasticSimulation<dim>::move();                                                  \
  template void   ElasticSimulation<dim>::note_energy(const ElasticRun<dim> &);                    \
  template void   ElasticSimulation<dim>::note_inversion(const ElasticRun<dim> &);                 \
  template nlohmann::ordered_json ElasticSimulation<dim>::add_energies(const ElasticRun<dim> &,    \
                                                                       const double);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
