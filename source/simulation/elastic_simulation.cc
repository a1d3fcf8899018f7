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
#include "elastic_sides.h"
#include "elastic_summary.h"
#include "finite_results.h"
#include "result_record.h"
#include "run_output.h"
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
    find_points();
  }


  template <int dim>
  void ElasticSimulation<dim>::find_points()
  {
    Timings::Scope                    scope(timings, "output");
    typename RunOutput<dim>::Problems problems;
    for (const auto &model : models)
      problems.push_back(model.get());
    output->find_points(problems);
    for (const std::string &note : output->gaps_in_line())
      record->notes.push_back(note);
  }


  template <int dim>
  void ElasticSimulation<dim>::add_totals(ElasticRun<dim> &model, const double t)
  {
    const auto row = [&](const std::string &quantity, const double value) {
      output->add_row(model.name(), quantity, value, t);
    };
    const ForceBalance          balance = model.op().forces(model.displacement, t);
    const double                energy  = model.op().energy(model.displacement);
    const SymmetricTensor<2, 3> mean    = model.mean_stress();
    require_finite(
      {{"largest displacement", model.displacement.linfty_norm()},
       {"strain energy", energy},
       {"sum of the forces", balance.throughput()},
       {"mean stress", von_mises(mean)}},
      model.name(),
      t,
      "Numbers beyond 1e308 came up. Check the sizes and units of loads and displacements (sections 'Boundary conditions' and 'Initial and source') and of the "
      "moduli (section 'Material').");
    row("strain energy", energy);
    for (const auto &[side, force] : balance.sides)
      for (unsigned int d = 0; d < dim; ++d)
        row("force on " + side + " in " + "xyz"[d], force[d]);
    if (!scene.time.steady)
      for (const auto &[side, moved] : displacements_of_sides(model, scene))
        for (unsigned int d = 0; d < dim; ++d)
          row("displacement of " + side + " in " + "xyz"[d], moved[d]);
    keep_largest_force(balance, t, record->extremes[model.name()]);
    progress.state(text_of_largest_force(balance));
    for (unsigned int d = 0; d < dim; ++d)
      row(std::string("body force in ") + "xyz"[d], balance.body[d]);
    row("throughput", balance.throughput());
    if (!model.stepper) // of a motion it is the rate of its momentum
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
    for (const StressIntensity &end : model.stress_intensities(t))
      {
        row("J-integral at " + end.name, end.j);
        row("stress intensity I at " + end.name, end.mode_1);
        row("stress intensity II at " + end.name, end.mode_2);
        ends[end.name] = {{"J-integral", end.j}, {"I", end.mode_1}, {"II", end.mode_2}};
      }
    record->balances[model.name()] = {{"boundary force", balance.sides},
                                      {"strain energy", energy},
                                      {"mean stress", stress}};
    if (model.stepper || model.op().brittle() ||
        (scene.is_loaded_slowly() && !scene.warms_slowly()))
      record->balances[model.name()]["energy balance"] = add_energies(model, t);
    if (!model.stepper)
      {
        model.force_scale =
          std::max(model.force_scale, find_force_scale(model, scene, balance.throughput()));
        record->balances[model.name()]["force balance"] = {{"throughput", balance.throughput()},
                                                           {"imbalance", balance.imbalance()},
                                                           {"scale", model.force_scale}};
      }
    if (!ends.empty())
      record->balances[model.name()]["stress intensity"] = ends;
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
    if (scene.elasticity.is_static())
      load();
    else
      {
        make_steppers();
        move();
      }
    for (const std::string &note : record->notes)
      progress.note(note);
    const auto summary = summary_now(true);
    output->complete(summary);
    return summary;
  }


  template <int dim>
  void ElasticSimulation<dim>::write_output(const double t)
  {
    progress.doing("writing results");
    Timings::Scope scope(timings, "output");
    for (const auto &model : models)
      add_totals(*model, t);
    write_state(t);
  }


  template <int dim>
  void ElasticSimulation<dim>::write_state(const double t)
  {
    output->write_points(t);
    output->write_fields(t);
    compare_displacements(models, scene.domain, t, record->comparison, record->comparisons);
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
    if (!scene.elasticity.is_static())
      make_steppers();
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
                                                  std::max(scene.time.end_time / load_step(),
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
  nlohmann::ordered_json ElasticSimulation<dim>::describe_solving(
    const ElasticRun<dim> &model) const
  {
    nlohmann::ordered_json entry{{"iterations", model.n_iterations}};
    if (model.stepper)
      {
        entry["stepper"]     = model.stepper->name();
        entry["steps"]       = model.stepper->cost().steps;
        entry["iterations"]  = model.stepper->cost().iterations;
        entry["time step"]   = model.stepper->current_step();
        entry["stable step"] = {{"sharp", model.stable_step}, {"method", "verlet"}};
      }
    if (model.loading && !scene.time.steady)
      {
        entry["steps"] = model.loading->n_steps();
        if (!scene.warms_slowly()) // then equilibria are at times of output
          entry["time step"] = load_step();
      }
    return entry;
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
        entry       = describe_problem<dim>(*model, describe_solving(*model), *record);
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
