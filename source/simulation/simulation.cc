// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/analysis/coupling_certificate.h>
#include <perideal/base/user_error.h>
#include <perideal/mesh/material_ids.h>
#include <perideal/mesh/mesh_builder.h>
#include <perideal/operators/bond_operator.h>
#include <perideal/scene/lists.h>
#include <perideal/simulation/estimate.h>
#include <perideal/simulation/simulation.h>
#include <perideal/solvers/linear_solver.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "check_sides.h"
#include "closing.h"
#include "crack_note.h"
#include "model_comparison.h"
#include "result_record.h"
#include "run_context.h"
#include "summary_parts.h"
#include "with_formulas.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  Simulation<dim>::Simulation(const Scene<dim> &scene,
                              const SceneText  &text,
                              const MPI_Comm    communicator,
                              const bool        quiet)
    : scene(scene)
    , text(text)
    , communicator(communicator)
    , progress(communicator, quiet)
    , record(std::make_unique<ResultRecord>())
    , output(std::make_unique<RunOutput<dim>>(scene, *record))
  {
    Assert(scene.general.physics != Physics::elasticity, ExcMessage("see ElasticSimulation"));
  }


  template <int dim>
  Simulation<dim>::~Simulation()
  {}


  template <int dim>
  std::vector<double> Simulation<dim>::output_times() const
  {
    if (scene.time.steady)
      return {0.};
    std::vector<double> times = scene.output.write_times;
    if (times.empty() || times.back() < scene.time.end_time)
      times.push_back(scene.time.end_time);
    return times;
  }


  template <int dim>
  void Simulation<dim>::build_on(const std::shared_ptr<Triangulation<dim>> &given_mesh)
  {
    mesh = given_mesh;
    build();
    make_steppers();
  }


  template <int dim>
  const ModelRun<dim> &Simulation<dim>::model(const unsigned int number) const
  {
    return *models[number];
  }


  template <int dim>
  const std::vector<std::string> &Simulation<dim>::notes() const
  {
    return record->notes;
  }


  template <int dim>
  void Simulation<dim>::build_mesh_of_run()
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
    check_points_of_parts(scene, *mesh, record->notes);
    note_missing_crack_scaling(scene, record->notes);
    progress.line("mesh: " + readable_count(mesh->n_global_active_cells()) + " cells");
  }


  template <int dim>
  void Simulation<dim>::build()
  {
    if (!mesh)
      build_mesh_of_run();
    if (!scene.cracks.tips.empty())
      {
        const CrackHistory<dim> history = scene.crack_history();
        record->notes.push_back(
          "the cracks grow in " + std::to_string(history.events().size()) +
          " events, between which no tip advances more than " +
          number_text(history.longest_advance()) +
          "; bonds are cut too early or too late by at most the time that it needs for half of that ('Growth step' in section "
          "'Cracks').");
      }
    unsigned int n_own_cells = 0;
    for (const auto &cell : mesh->active_cell_iterators())
      n_own_cells += cell->is_locally_owned() ? 1 : 0;
    AssertThrow(Utilities::MPI::min(n_own_cells, communicator) > 0,
                UserError("A mesh of " + std::to_string(mesh->n_global_active_cells()) +
                          " cells leaves some of the " +
                          std::to_string(Utilities::MPI::n_mpi_processes(communicator)) +
                          " processes without any. Use fewer processes or more 'Cells' (section "
                          "'Domain')."));
    with_formulas(communicator, [&] { check_sides(scene, *mesh); });
    if (scene.peridynamics.flux_treatment != FluxTreatment::natural &&
        scene.boundary_conditions.flux.empty())
      record->notes.push_back(
        "'Flux treatment' in section 'Peridynamics' has no effect: no side is named in 'Flux' (an insulated side "
        "needs 'side: 0' there).");
    for (const ModelKind model : scene.general.models)
      {
        if (output->is_open())
          progress.doing("building " + to_string(model));
        with_formulas(communicator, [&] { models.push_back(make_model_run(model, *mesh, scene)); });
        describe(*models.back());
        for (const std::string &note : models.back()->notes())
          record->notes.push_back(models.back()->name() + ": " + note);
      }
    prepare_adaptation();
    make_reference();
  }


  template <int dim>
  void Simulation<dim>::describe(const ModelRun<dim> &model) const
  {
    const OperatorSize size = model.op().size();
    std::string        line = model.name() + ": " + readable_count(size.unknowns) + " unknowns";
    if (size.bonds > 0)
      line += ", " + readable_count(size.bonds) + " bonds";
    if (size.nonzeros > 0)
      line += ", " + readable_count(size.nonzeros) +
              (size.form == "lattice" ? " stored corrections" : " stored numbers");
    const double memory = Utilities::MPI::sum(static_cast<double>(size.memory), communicator);
    progress.line(line + ", " + readable_bytes(memory));
    for (const auto &[name, value] : model.settings())
      if (name == "operator form")
        progress.line("  form: " + value);
      else if (name == "calibration" && value.find("because") != std::string::npos)
        progress.line("  calibration: " + value);
    if (const CouplingCertificate *certificate = model.examined())
      progress.line(certificate_line(*certificate));
  }


  template <int dim>
  void Simulation<dim>::make_reference()
  {
    if (scene.reference.solution.empty())
      return;
    ExactSolutionContext context;
    context.dim = dim;
    context.lower.resize(dim);
    context.upper.resize(dim);
    for (unsigned int d = 0; d < dim; ++d)
      {
        context.lower[d] = scene.domain.lower[d];
        context.upper[d] = scene.domain.upper[d];
      }
    const Point<dim> middle = scene.domain.lower + 0.5 * (scene.domain.upper - scene.domain.lower);
    context.conductivity    = scene.material.conductivity.value(middle);
    context.storage         = scene.material.storage(middle);
    context.kernel          = scene.peridynamics.kernel;
    context.exponent        = scene.peridynamics.kernel_exponent;
    if (scene.domain.shape != Shape::mesh_file)
      {
        context.horizon = scene.horizon();
        context.family  = lattice_terms(lattice_family<dim>(scene.domain.spacing(),
                                                           context.horizon,
                                                           scene.peridynamics.kernel,
                                                           scene.peridynamics.kernel_exponent,
                                                           scene.peridynamics.volume_fraction,
                                                           scene.peridynamics.calibration),
                                       scene.domain.spacing(),
                                       context.conductivity);
      }
    if (scene.domain.shape != Shape::box)
      context.no_named = "is the solution in a box, but 'Shape' in section 'Domain' is another.";
    else if (!scene.material.conductivity.is_constant() || !scene.material.density.is_constant() ||
             !scene.material.heat_capacity.is_constant())
      context.no_named = "holds for a uniform material only (section 'Material').";
    exact = make_exact_solution(scene.reference.solution, context);
  }


  template <int dim>
  std::vector<const Problem<dim> *> Simulation<dim>::problems() const
  {
    std::vector<const Problem<dim> *> list;
    for (const auto &model : models)
      list.push_back(model.get());
    return list;
  }


  template <int dim>
  void Simulation<dim>::run()
  {
    require_memory(scene, communicator);
    output->open(text, communicator);
    nlohmann::ordered_json summary;
    with_orderly_end(output->files(), progress, [&] { summary = compute(); });
    output->close();
    progress.end();
    say_what_was_found(progress, summary, scene.general.output_directory);
  }


  template <int dim>
  nlohmann::ordered_json Simulation<dim>::compute()
  {
    build();
    {
      Timings::Scope scope(timings, "output");
      output->find_points(problems());
      for (const std::string &note : output->gaps_in_line())
        record->notes.push_back(note);
    }
    make_steppers();
    const std::vector<double> times = output_times();
    if (scene.time.steady)
      progress.line("steady state");
    progress.begin("time");
    if (scene.output.starts_at_zero())
      with_formulas(communicator, [&] { write_start(); });
    for (const double t : times)
      {
        advance_to(t);
        progress.update(scene.time.steady ? 1. : t / scene.time.end_time);
        progress.doing("writing results");
        Timings::Scope scope(timings, "output");
        with_formulas(communicator, [&] { write_output(t); });
        output->end_time([&] { return summary_now(); },
                         scene.time.steady ? "the steady state" : "until t = " + full_precision(t));
      }
    progress.end();
    if (n_adaptations > 0)
      record->notes.push_back("the mesh was adapted " + std::to_string(n_adaptations) +
                              (n_adaptations == 1 ? " time" : " times") + "; it has " +
                              readable_count(mesh->n_global_active_cells()) +
                              " cells at the end ('Zone = adaptive' in section 'Coupling').");
    for (const std::string &note : record->notes)
      progress.note(note);
    const nlohmann::ordered_json summary = summary_now();
    output->complete(summary);
    return summary;
  }


  template <int dim>
  void Simulation<dim>::add_errors(const double t)
  {
    if (!exact)
      return;
    for (const auto &model : models)
      {
        const Difference error = model->error(model->solution, [&](const Point<dim> &p) {
          double x[dim];
          for (unsigned int d = 0; d < dim; ++d)
            x[d] = p[d];
          return exact->value(x, t);
        });
        record->errors[model->name()]["relative l2"].push_back({t, error.relative_l2});
        record->errors[model->name()]["maximum"].push_back({t, error.maximum});
      }
  }


  template <int dim>
  void Simulation<dim>::write_output(const double t)
  {
    if (!readers_fit)
      output->find_points(problems());
    readers_fit = true;
    for (auto &model : models) // refuses what is not finite before it is written
      model->add_totals(t, {progress, *record, *output});
    for (auto &model : models)
      model->solution.update_ghost_values();
    typename RunOutput<dim>::Values known;
    if (exact)
      known = [&](const std::vector<double> &p) { return exact->value(p.data(), t); };
    output->write_points(t, known);
    add_errors(t);
    compare_models(problems(), scene.domain, t, *record);
    write_fields(t);
    for (auto &model : models)
      model->solution.set_ghost_state(false);
  }


  template <int dim>
  void Simulation<dim>::write_start()
  {
    Timings::Scope scope(timings, "output");
    for (auto &model : models)
      model->solution.update_ghost_values();
    write_fields(0.);
    for (auto &model : models)
      model->solution.set_ghost_state(false);
  }


  template <int dim>
  void Simulation<dim>::write_fields(const double t)
  {
    std::map<std::string, OutputField> more;
    for (Vector &difference : difference_of_models(problems()))
      more.emplace(to_string(ModelKind::peridynamics),
                   OutputField{"peridynamics_minus_finite_elements", {std::move(difference)}});
    output->write_fields(t, more);
  }


#define PERIDEAL_INSTANTIATE(dim)                                                              \
  template Simulation<dim>::Simulation(const Scene<dim> &,                                     \
                                       const SceneText &,                                      \
                                       const MPI_Comm,                                         \
                                       const bool);                                            \
  template Simulation<dim>::~Simulation();                                                     \
  template void Simulation<dim>::build();                                                      \
  template void Simulation<dim>::build_on(const std::shared_ptr<Triangulation<dim>> &);        \
  template const ModelRun<dim>              &Simulation<dim>::model(const unsigned int) const; \
  template const std::vector<std::string>   &Simulation<dim>::notes() const;                   \
  template std::vector<const Problem<dim> *> Simulation<dim>::problems() const;                \
  template std::vector<double>               Simulation<dim>::output_times() const;            \
  template void                              Simulation<dim>::run();
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
