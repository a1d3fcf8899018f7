// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <perideal/base/memory.h>
#include <perideal/base/user_error.h>
#include <perideal/laws/elasticity.h>
#include <perideal/mesh/material_ids.h>
#include <perideal/mesh/mesh_builder.h>
#include <perideal/scene/lists.h>
#include <perideal/simulation/elastic_simulation.h>
#include <perideal/simulation/estimate.h>
#include <perideal/solvers/static_solver.h>

#include <algorithm>
#include <utility>

#include "check_sides.h"
#include "closing.h"
#include "elastic_phases.h"
#include "elastic_summary.h"
#include "model_comparison.h"
#include "run_context.h"
#include "scene_sample.h"
#include "summary_parts.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  ElasticSimulation<dim>::ElasticSimulation(const Scene<dim> &scene,
                                            const SceneText  &text,
                                            const MPI_Comm    communicator,
                                            const bool        quiet)
    : scene(scene)
    , text(text)
    , communicator(communicator)
    , quiet(quiet)
    , progress(communicator, quiet)
    , record(std::make_unique<ResultRecord>())
    , output(std::make_unique<RunOutput<dim>>(scene, *record))
  {}


  template <int dim>
  ElasticSimulation<dim>::~ElasticSimulation() = default;


  namespace
  {
    /** What cannot be computed, so that no scene is silently taken for another. */
    template <int dim>
    void refuse_what_is_not_computed(const Scene<dim> &scene)
    {
      const auto require = [](const bool ok, const std::string &what) {
        AssertThrow(ok, UserError(what));
      };
      const auto &models = scene.general.models;
      require(
        scene.elasticity.kinematics == Kinematics::linear ||
          std::find(models.begin(), models.end(), ModelKind::finite_elements) == models.end(),
        "'Kinematics' in section 'Elasticity': 'full' is for 'Models = peridynamics' alone; finite elements have small displacements. "
        "Leave them out, or use 'linear'.");
      require(scene.cracks.tips.empty(),
              "'Growth' in section 'Cracks' cannot be used with 'Physics = elasticity' yet.");
      require(scene.domain.coarsening == 0,
              "'Coarsening' in section 'Domain' cannot be used with 'Physics = elasticity' yet.");
      require(scene.reference.solution.empty(),
              "'Solution' in section 'Reference' cannot be used with 'Physics = elasticity' yet.");
    }


    /** Bonds alone have a Poisson ratio of their own, and keep the bulk modulus. Collective. */
    template <int dim>
    void note_own_poisson_ratio(const Scene<dim>         &scene,
                                const Triangulation<dim> &mesh,
                                std::vector<std::string> &notes)
    {
      const auto &models = scene.general.models;
      if (dim == 1 || scene.elasticity.model != ElasticModel::bond_based ||
          std::find(models.begin(), models.end(), ModelKind::peridynamics) == models.end())
        return;
      const double own    = bond_based_poisson(dim, scene.elasticity.plane);
      double       lowest = 1., highest = -1.;
      for (const auto &cell : mesh.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            const double nu = scene.material.moduli(cell->center()).poisson();
            lowest          = std::min(lowest, nu);
            highest         = std::max(highest, nu);
          }
      lowest  = Utilities::MPI::min(lowest, mesh.get_communicator());
      highest = Utilities::MPI::max(highest, mesh.get_communicator());
      if (std::max(highest - own, own - lowest) < 1e-3)
        return;
      std::string found = number_text(lowest);
      if (highest > lowest)
        found += " to " + number_text(highest);
      notes.push_back(
        "'Model = bond-based' in section 'Elasticity' has a Poisson ratio of " + number_text(own) +
        " whatever 'Material' says, which is " + found +
        ": only the stiffness against equal strains in all directions is that of the material. "
        "Use 'state-based', or that Poisson ratio.");
    }
  } // namespace


  template <int dim>
  void ElasticSimulation<dim>::build()
  {
    const unsigned int n_proc = Utilities::MPI::n_mpi_processes(communicator);
    progress.line(scene.general.title + "  (" + text.file_name + ", " + std::to_string(n_proc) +
                  (n_proc == 1 ? " process)" : " processes)"));
    {
      progress.doing("building the mesh");
      Timings::Scope scope(timings, "mesh");
      mesh = build_mesh(scene, communicator, record->notes);
      set_material_ids(*mesh, scene.material.phases.all());
    }
    check_sides(scene, *mesh);
    check_points_of_parts(scene, *mesh, record->notes);
    note_own_poisson_ratio(scene, *mesh, record->notes);
    progress.line("mesh: " + readable_count(mesh->n_global_active_cells()) + " cells");
    for (const ModelKind kind : scene.general.models)
      {
        progress.doing("building " + to_string(kind));
        models.push_back(make_elastic_run(kind, *mesh, scene));
        const ElasticRun<dim> &model = *models.back();
        const OperatorSize     size  = model.op().size();
        std::string line = model.name() + ": " + readable_count(size.unknowns) + " unknowns";
        if (size.bonds > 0)
          line += ", " + readable_count(size.bonds) + " bonds";
        line += ", " + readable_count(size.nonzeros) + " stored numbers";
        for (const std::string &note : model.notes())
          record->notes.push_back(note);
        const double memory = Utilities::MPI::sum(static_cast<double>(size.memory), communicator);
        progress.line(line + ", " + readable_bytes(memory));
        if (const CouplingCertificate *certificate = model.examined())
          progress.line(certificate_line(*certificate));
      }
    build_heat();
    Timings::Scope scope(timings, "output");
    output->find_points(problems());
    for (const std::string &note : output->gaps_in_line())
      record->notes.push_back(note);
  }


  template <int dim>
  RunContext<dim> ElasticSimulation<dim>::context()
  {
    return {progress, *record, *output};
  }


  template <int dim>
  std::vector<const Problem<dim> *> ElasticSimulation<dim>::problems() const
  {
    std::vector<const Problem<dim> *> list;
    for (const auto &model : models)
      list.push_back(model.get());
    return list;
  }


  template <int dim>
  void ElasticSimulation<dim>::run()
  {
    refuse_what_is_not_computed(scene);
    require_memory(scene, communicator);
    output->open(text, communicator);
    nlohmann::ordered_json summary;
    with_orderly_end(output->files(), progress, [&] { summary = compute(); });
    output->close();
    progress.end();
    say_what_was_found(progress, summary, scene.general.output_directory);
  }


  template <int dim>
  nlohmann::ordered_json ElasticSimulation<dim>::compute()
  {
    build();
    for (const auto &model : models)
      model->begin(context());
    if (!scene.time.steady)
      progress.begin("time");
    warm_until(0.);
    for (const auto &model : models)
      model->settle(context());
    note_sudden_heat();
    const bool at_stops = std::any_of(models.begin(), models.end(), [](const auto &model) {
      return model->tells_at_stops();
    });
    if (at_stops)
      add_totals(0.);
    if (scene.output.starts_at_zero() && !scene.time.steady)
      output->write_fields(0.);
    if (at_stops)
      end_output(0.);
    double now = 0.;
    for (const double t : times_of_output())
      {
        advance(now, t, at_stops);
        now = t;
        write_output(t, !at_stops);
      }
    progress.end();
    for (const auto &model : models)
      model->note_end(context());
    for (const std::string &note : record->notes)
      progress.note(note);
    const auto summary = summary_now(true);
    output->complete(summary);
    return summary;
  }


  template <int dim>
  void ElasticSimulation<dim>::advance(const double now, const double t, const bool at_stops)
  {
    if (!(t > now))
      return;
    std::vector<double> stops;
    for (const auto &model : models)
      for (const double stop : model->stops(now, t))
        stops.push_back(stop);
    std::sort(stops.begin(), stops.end());
    stops.erase(std::unique(stops.begin(), stops.end()), stops.end());
    double from = now;
    for (unsigned int n = 0; n < stops.size(); ++n)
      {
        const double to = stops[n];
        if (scene.warms_slowly())
          warm_until(to);
        for (unsigned int k = 0; k < models.size(); ++k)
          {
            const double before = share_done(k, from, to), after = share_done(k + 1, from, to);
            progress.doing(models[k]->doing(n + 1, stops.size(), t));
            if (!at_stops)
              progress.advancing(from, to, before, after);
            models[k]->advance(
              from,
              to,
              [&](const double share) { progress.update(before + share * (after - before)); },
              context());
          }
        from = to;
        if (!at_stops)
          continue;
        Timings::Scope scope(timings, "output");
        add_totals(to);
        end_output(to);
        progress.update(to / scene.time.end_time);
      }
  }


  template <int dim>
  double ElasticSimulation<dim>::share_done(const unsigned int n,
                                            const double       from,
                                            const double       to) const
  {
    double some = 0., all = 0.;
    for (unsigned int k = 0; k < models.size(); ++k)
      {
        const double work = models[k]->work_of(to - from);
        all += work;
        if (k < n)
          some += work;
      }
    return (from + some / all * (to - from)) / scene.time.end_time;
  }


  template <int dim>
  void ElasticSimulation<dim>::add_totals(const double t)
  {
    for (const auto &model : models)
      model->add_totals(t, context());
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
  std::vector<double> ElasticSimulation<dim>::times_of_output() const
  {
    if (scene.time.steady)
      return {0.};
    std::vector<double> times = scene.output.write_times;
    if (times.empty() || times.back() < scene.time.end_time)
      times.push_back(scene.time.end_time);
    return times;
  }


  template <int dim>
  void ElasticSimulation<dim>::write_output(const double t, const bool with_totals)
  {
    for (const auto &model : models)
      model->examine(t);
    progress.doing("writing results");
    Timings::Scope scope(timings, "output");
    if (with_totals)
      add_totals(t);
    output->write_points(t);
    output->write_fields(t);
    compare_models(problems(), scene.domain, t, *record);
    end_output(t);
  }


  template <int dim>
  void ElasticSimulation<dim>::end_output(const double t)
  {
    output->end_time([&] { return summary_now(false); },
                     scene.time.steady ? "the equilibrium" : "until t = " + full_precision(t));
  }


  template <int dim>
  void ElasticSimulation<dim>::dry_run()
  {
    refuse_what_is_not_computed(scene);
    const double before = Utilities::MPI::sum(resident_memory(), communicator);
    build();
    for (const auto &model : models)
      model->begin(context());
    for (const std::string &note : record->notes)
      progress.note(note);
    describe_costs_of_run(before);
    progress.line("The scene is valid. Nothing was computed.");
  }


  template <int dim>
  void ElasticSimulation<dim>::describe_costs_of_run(const double before)
  {
    double              computing = heat ? heat->time_of_run() : 0., memory = 0.;
    std::vector<double> components;
    for (const auto &model : models)
      {
        if (!model->stepper)
          model->op().initialize_vector(model->displacement);
        components.push_back(0.);
        for (const OutputField &field : model->fields(0.))
          components.back() += field.components.size();
        const double own = model->stepper ?
                             time_of_motion(*model) :
                             time_of_equilibria(scene,
                                                model->op(),
                                                components.size() - 1,
                                                scene.time.steady ?
                                                  1. :
                                                  std::max(scene.time.end_time / model->load_step(),
                                                           1. * times_of_output().size()),
                                                communicator,
                                                memory);
        computing        = own >= 0. && computing >= 0. ? computing + own : -1.;
      }
    for (const std::string &line : describe_costs(scene,
                                                  computing,
                                                  before + memory,
                                                  mesh->n_global_active_cells(),
                                                  components,
                                                  communicator))
      progress.line(line);
  }


  template <int dim>
  double ElasticSimulation<dim>::time_of_motion(ElasticRun<dim> &model)
  {
    const double step = model.stepper->current_step(), end = scene.time.end_time;
    const double from = std::min(step, end), to = std::min(4. * step, end);
    model.stepper->advance(model.displacement, model.velocity, 0., from);
    if (!(to > from))
      return 0.;
    const double before = progress.elapsed();
    model.stepper->advance(model.displacement, model.velocity, from, to);
    return (progress.elapsed() - before) * end / (to - from);
  }


  template <int dim>
  nlohmann::ordered_json ElasticSimulation<dim>::summary_now(const bool at_the_end)
  {
    using json   = nlohmann::ordered_json;
    json summary = describe_scene(scene, text, *mesh, communicator);
    describe_run(scene, *mesh, *record, timings, summary);
    summary["solver"] = scene.elasticity.solver_name();
    summary["sides"]  = describe_elastic_sides(scene);
    for (const auto &model : models)
      {
        json &entry = summary["models"][model->name()];
        entry       = describe_problem<dim>(*model, model->describe_solving(), *record);
        if (at_the_end)
          if (const json phases = describe_phases(*model, scene, record->totals, communicator);
              !phases.empty())
            entry["phases"] = phases;
      }
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
    return summary;
  }


  template class ElasticSimulation<1>;
  template class ElasticSimulation<2>;
  template class ElasticSimulation<3>;
} // namespace PeriDeal
