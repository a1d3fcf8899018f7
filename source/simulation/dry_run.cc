// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/simulation/estimate.h>
#include <perideal/simulation/simulation.h>

#include <algorithm>
#include <sstream>

#include "result_record.h"
#include "run_output.h"

namespace PeriDeal
{
  template <int dim>
  void Simulation<dim>::dry_run()
  {
    build();
    output->find_points(problems());
    for (const std::string &note : output->gaps_in_line())
      record->notes.push_back(note);
    make_steppers();
    double computing = 0.; // in seconds, negative if it is not known
    for (const auto &model : models)
      {
        std::ostringstream out;
        out << model->name() << ":";
        progress.line(out.str());
        if (scene.time.steady)
          {
            progress.line("  steady: one linear solve, about 20 iterations");
            computing += time_of_run(*model);
            continue;
          }
        const Spectrum spectrum = model->op().spectrum();
        out.str("");
        out << "  largest eigenvalue: sharp bound " << spectrum.sharp << ", safe bound "
            << spectrum.safe << "\n"
            << "  stable steps (sharp / safe): euler " << stable_step("euler", spectrum.sharp)
            << " / " << stable_step("euler", spectrum.safe) << ", rk4 "
            << stable_step("rk4", spectrum.sharp) << " / " << stable_step("rk4", spectrum.safe)
            << "\n"
            << "  stepper: " << model->stepper->name();
        progress.line(out.str());
        const double n    = model->expected_applications(output_times());
        const double time = time_of_run(*model);
        computing         = time >= 0. && computing >= 0. ? computing + time : -1.;
        if (n > 0.)
          progress.line("  estimated: " + readable_count(static_cast<unsigned long long>(n)) +
                        " operator applications, " + readable_duration(time));
      }
    if (grading)
      progress.line("With 'Zone = adaptive' all figures are those of the mesh at the start.");
    for (const std::string &note : record->notes)
      progress.note(note);
    std::vector<double> components;
    for (unsigned int k = 0; k < models.size(); ++k)
      components.push_back(components_written(k));
    for (const std::string &line : describe_costs(scene,
                                                  computing,
                                                  0.,
                                                  mesh->n_global_active_cells(),
                                                  components,
                                                  communicator))
      progress.line(line);
    progress.line("The scene is valid. Nothing was computed.");
  }


  template <int dim>
  unsigned int Simulation<dim>::components_written(const unsigned int number) const
  {
    const Vector &u = models[number]->solution;
    u.update_ghost_values();
    unsigned int n = 1;
    for (const OutputField &field : models[number]->derived_fields(u, 0.))
      n += field.components.size();
    u.set_ghost_state(false);
    return n + (models[number]->name() == to_string(ModelKind::peridynamics) && models.size() > 1 ?
                  1 :
                  0);
  }


  template <int dim>
  double Simulation<dim>::time_of_run(const ModelRun<dim> &model) const
  {
    // A linear solution takes about 20 iterations, each with its preconditioner 6 applications.
    constexpr double of_solution = 20. * 6.;
    const double n = scene.time.steady ? of_solution : model.expected_applications(output_times());
    return n > 0. ? n * time_of_application(model) : -1.;
  }


  template <int dim>
  double Simulation<dim>::time_of_run() const
  {
    double time = 0.;
    for (const auto &model : models)
      {
        const double own = time_of_run(*model);
        time             = own >= 0. && time >= 0. ? time + own : -1.;
      }
    return time;
  }


  template <int dim>
  double Simulation<dim>::time_of_application(const ModelRun<dim> &model) const
  {
    Vector x, y;
    model.op().initialize_vector(x);
    model.op().initialize_vector(y);
    Timings                trial;
    constexpr unsigned int n_trials = 5;
    model.op().apply(y, x);
    for (unsigned int k = 0; k < n_trials; ++k)
      {
        Timings::Scope scope(trial, "apply");
        model.op().apply(y, x);
      }
    return trial.total() / n_trials;
  }


  template void         Simulation<1>::dry_run();
  template void         Simulation<2>::dry_run();
  template void         Simulation<3>::dry_run();
  template double       Simulation<1>::time_of_run() const;
  template double       Simulation<2>::time_of_run() const;
  template double       Simulation<3>::time_of_run() const;
  template unsigned int Simulation<1>::components_written(const unsigned int) const;
  template unsigned int Simulation<2>::components_written(const unsigned int) const;
  template unsigned int Simulation<3>::components_written(const unsigned int) const;
} // namespace PeriDeal
