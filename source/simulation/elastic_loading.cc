// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Bodies at rest: one equilibrium, or one after the other where loads depend on time.

#include <perideal/base/user_error.h>
#include <perideal/scene/lists.h>
#include <perideal/simulation/elastic_simulation.h>
#include <perideal/solvers/step_tools.h>

#include <algorithm>

#include "elastic_notes.h"
#include "summary_parts.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void ElasticSimulation<dim>::load()
  {
    warm_until(0.);
    for (const auto &model : models)
      {
        progress.doing("solving " + model->name());
        model->begin_loading(context());
        if (scene.time.steady)
          progress.line(model->name() + ": " + std::to_string(model->n_iterations) + " iterations");
      }
    note_sudden_heat();
    if (scene.time.steady)
      {
        write_output(0.);
        for (const auto &model : models)
          note_end(*model, context());
        return;
      }
    progress.begin("time");
    for (const auto &model : models)
      model->load_step = load_step();
    for (const auto &model : models)
      model->add_totals(0., context());
    if (scene.output.starts_at_zero())
      output->write_fields(0.);
    end_output(0.);
    double now = 0.;
    for (const double t : times_of_output())
      {
        if (t > now)
          load_until(now, t);
        now = t;
        progress.doing("writing results");
        Timings::Scope scope(timings, "output");
        write_state(t);
      }
    progress.end();
    for (const auto &model : models)
      {
        progress.line(model->name() + ": " + std::to_string(model->n_iterations) + " iterations");
        note_end(*model, context());
      }
  }


  template <int dim>
  void ElasticSimulation<dim>::note_sudden_heat()
  {
    if (!heat || scene.boundary_conditions.dirichlet.empty())
      return;
    for (const auto &model : models)
      if (model->op().brittle() && model->op().n_broken_bonds() > 0)
        record->notes.push_back(
          model->name() + ": " + readable_count(model->op().n_broken_bonds()) +
          " bonds broke at t = 0 already. 'Dirichlet' in section 'Boundary conditions' gives its sides their temperature at once, so that the outermost nodes "
          "are stretched against the next ones by all of the jump, however fine the lattice. 'Convection', or a 'Dirichlet' value that begins at the initial one, lets the heat in gradually.");
  }


  template <int dim>
  double ElasticSimulation<dim>::load_step() const
  {
    constexpr double share = 0.01; // of the end time, if no step is given
    if (scene.warms_slowly())      // `Time step` is that of the heat problem
      {
        const bool remembers = std::any_of(models.begin(), models.end(), [](const auto &model) {
          return model->op().brittle() || model->op().nonlinear();
        });
        return (remembers ? share : 1.) * scene.time.end_time;
      }
    return scene.time.time_step > 0. ? scene.time.time_step : share * scene.time.end_time;
  }


  template <int dim>
  std::vector<double> ElasticSimulation<dim>::times_of_output() const
  {
    std::vector<double> times = scene.output.write_times;
    if (times.empty() || times.back() < scene.time.end_time)
      times.push_back(scene.time.end_time);
    return times;
  }


  template <int dim>
  void ElasticSimulation<dim>::load_until(const double now, const double t)
  {
    const unsigned long long n = n_equal_steps(t - now, load_step());
    for (unsigned long long k = 1; k <= n; ++k)
      {
        const double to = k == n ? t : now + k * (t - now) / n;
        if (scene.warms_slowly())
          warm_until(to);
        for (const auto &model : models)
          {
            progress.doing("solving " + model->name() + ", load step " + std::to_string(k) +
                           " of " + std::to_string(n) + " until t = " + number_text(t));
            Timings::Scope scope(model->timings, "solving");
            model->loading->step(model->displacement, to);
            model->n_iterations = model->loading->n_iterations();
            tell_first_break(*model, to, context());
          }
        Timings::Scope scope(timings, "output");
        for (const auto &model : models)
          model->add_totals(to, context());
        end_output(to);
        progress.update(to / scene.time.end_time);
      }
  }


#define PERIDEAL_INSTANTIATE(dim)                                         \
  template void                ElasticSimulation<dim>::load();            \
  template double              ElasticSimulation<dim>::load_step() const; \
  template std::vector<double> ElasticSimulation<dim>::times_of_output() const;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
