// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <perideal/base/user_error.h>
#include <perideal/laws/elasticity.h>
#include <perideal/mesh/material_ids.h>
#include <perideal/mesh/mesh_builder.h>
#include <perideal/simulation/elastic_simulation.h>
#include <perideal/solvers/linear_solver.h>

#include <algorithm>

#include "elastic_phases.h"
#include "result_record.h"
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
    , progress(communicator, quiet)
    , probes(scene.output.probes, dim, elastic_columns(dim))
    , line(scene.output.line, dim, elastic_columns(dim))
    , record(std::make_unique<ResultRecord>())
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
      require(scene.elasticity.solver == ElasticSolver::linear,
              "'Solver = " + scene.elasticity.solver_name() +
                "' in section 'Elasticity' cannot be run yet; use 'linear'.");
      const auto &models = scene.general.models;
      require(std::find(models.begin(), models.end(), Model::coupled) == models.end(),
              "'Models = coupled' cannot be run with 'Physics = elasticity' yet.");
      require(
        std::find(models.begin(), models.end(), Model::finite_elements) == models.end() ||
          scene.cracks.cracks.empty() || scene.cracks.mesh == CrackMesh::faces,
        "'Mesh' in section 'Cracks' has to be 'faces' for finite elements with 'Physics = elasticity'.");
      require(scene.domain.coarsening == 0,
              "'Coarsening' in section 'Domain' cannot be used with 'Physics = elasticity' yet.");
      require(
        scene.boundary_conditions.traction_layer < 0.,
        "'Traction layer' in section 'Boundary conditions' cannot be used yet; leave it empty.");
      require(
        !scene.material.fracture_energy && !scene.material.critical_stretch,
        "'Fracture energy' and 'Critical stretch' in section 'Material' cannot be used yet; leave them empty.");
      require(
        scene.peridynamics.treatment == BoundaryTreatment::none,
        "'Boundary treatment' in section 'Peridynamics' has to be 'none' with 'Physics = elasticity'.");
      require(scene.reference.solution.empty(),
              "'Solution' in section 'Reference' cannot be used with 'Physics = elasticity' yet.");
    }
  } // namespace


  template <int dim>
  void ElasticSimulation<dim>::build()
  {
    refuse_what_is_not_computed(scene);
    const unsigned int n_proc = Utilities::MPI::n_mpi_processes(communicator);
    progress.line(scene.general.title + "  (" + text.file_name + ", " + std::to_string(n_proc) +
                  (n_proc == 1 ? " process)" : " processes)"));
    {
      Timings::Scope scope(timings, "mesh");
      mesh = build_mesh(scene, communicator, record->notes);
      set_material_ids(*mesh, scene.material.phases.all());
    }
    progress.line("mesh: " + readable_count(mesh->n_global_active_cells()) + " cells");
    for (const Model kind : scene.general.models)
      {
        models.push_back(make_elastic_run(kind, *mesh, scene));
        const ElasticRun<dim> &model = *models.back();
        const OperatorSize     size  = model.op().size();
        std::string line = model.name() + ": " + readable_count(size.unknowns) + " unknowns";
        if (size.bonds > 0)
          line += ", " + readable_count(size.bonds) + " bonds";
        line += ", " + readable_count(size.nonzeros) + " stored numbers";
        const double memory = Utilities::MPI::sum(static_cast<double>(size.memory), communicator);
        progress.line(line + ", " + readable_bytes(memory));
      }
  }


  template <int dim>
  void ElasticSimulation<dim>::solve(ElasticRun<dim> &model)
  {
    Timings::Scope   scope(model.timings, "solving");
    ElasticOperator &op = model.op();
    op.initialize_vector(model.displacement);
    op.distribute(model.displacement, 0.);
    Vector rhs, change;
    op.initialize_vector(rhs);
    op.initialize_vector(change);
    op.residual(rhs, model.displacement, 0.);
    LinearSolver solver(op,
                        scene.solver.tolerance,
                        scene.solver.max_iterations,
                        scene.solver.direct_up_to);
    model.n_iterations = solver.solve(0., 1., change, rhs);
    model.displacement += change;
    AssertThrow(
      std::isfinite(model.displacement.l1_norm()),
      UserError(
        "The displacement is not finite. Check the material, the boundary values and whether every part of the body is held."));
    progress.line(model.name() + ": " + std::to_string(model.n_iterations) + " iterations");
  }


  template <int dim>
  void ElasticSimulation<dim>::write_points()
  {
    const auto add = [&](const std::vector<std::vector<double>> &points,
                         const std::string                      &entry,
                         PointTable                             &table) {
      if (points.empty())
        return;
      for (const auto &model : models)
        {
          const PointEvaluator<dim> reader(model->dofs(),
                                           model->nodes(),
                                           scene.cracks,
                                           points,
                                           entry);
          table.add(0., model->name(), model->at_points(reader, points));
        }
    };
    add(scene.output.probes, "Probes", probes);
    add(scene.output.line, "Line", line);
  }


  template <int dim>
  void ElasticSimulation<dim>::write_fields()
  {
    if (!scene.output.vtu && !scene.output.hdf5)
      return;
    nlohmann::ordered_json files = nlohmann::ordered_json::object();
    for (const auto &model : models)
      {
        std::string series = model->name();
        std::replace(series.begin(), series.end(), ' ', '_');
        FieldWriter<dim>  writer(model->dofs(), scene.general.output_directory, series);
        const std::string name =
          writer.write(model->fields(), 0., scene.output.vtu, scene.output.hdf5);
        if (!name.empty())
          files[model->name()] = name;
      }
    record->fields.push_back({{"time", 0.}, {"files", files}});
  }


  template <int dim>
  void ElasticSimulation<dim>::add_totals(const ElasticRun<dim> &model)
  {
    const auto row = [&](const std::string &quantity, const double value) {
      record->totals += "0," + model.name() + "," + quantity + "," + full_precision(value) + "\n";
    };
    const ForceBalance balance = model.op().forces(model.displacement, 0.);
    const double       energy  = model.op().energy(model.displacement);
    row("strain energy", energy);
    for (const auto &[side, force] : balance.sides)
      for (unsigned int d = 0; d < dim; ++d)
        row("force on " + side + " in " + "xyz"[d], force[d]);
    for (unsigned int d = 0; d < dim; ++d)
      row(std::string("body force in ") + "xyz"[d], balance.body[d]);
    row("throughput", balance.throughput());
    row("imbalance", balance.imbalance());
    const SymmetricTensor<2, 3> mean   = model.mean_stress();
    nlohmann::ordered_json      stress = nlohmann::ordered_json::object();
    for (unsigned int a = 0; a < 3; ++a)
      for (unsigned int b = a; b < 3; ++b)
        if (b < dim || (dim == 2 && a == 2))
          {
            const std::string name = std::string(1, "xyz"[a]) + "xyz"[b];
            row("mean stress " + name, mean[a][b]);
            stress[name] = mean[a][b];
          }
    stress["von mises"]            = von_mises(mean);
    record->balances[model.name()] = {
      {"boundary force", balance.sides},
      {"force balance", {{"throughput", balance.throughput()}, {"imbalance", balance.imbalance()}}},
      {"strain energy", energy},
      {"mean stress", stress}};
  }


  template <int dim>
  void ElasticSimulation<dim>::run()
  {
    prepare_directory(scene.general.output_directory, text.file_name, communicator);
    write_image_as_read(scene, communicator);
    build();
    for (const auto &model : models)
      solve(*model);
    Timings::Scope scope(timings, "output");
    write_points();
    write_fields();
    for (const auto &model : models)
      add_totals(*model);
    for (const std::string &note : record->notes)
      progress.note(note);
    write_summary();
    progress.line("Results: " + scene.general.output_directory);
  }


  template <int dim>
  void ElasticSimulation<dim>::dry_run()
  {
    build();
    for (const std::string &note : record->notes)
      progress.note(note);
    progress.line("The scene is valid. Nothing was computed.");
  }


  template <int dim>
  void ElasticSimulation<dim>::write_summary()
  {
    using json           = nlohmann::ordered_json;
    json summary         = describe_scene(scene, text, *mesh, communicator);
    summary["cracks"]    = corners_of(scene.cracks.pieces(scene.cracks.end_time));
    summary["steady"]    = true;
    summary["notes"]     = record->notes;
    summary["fields"]    = record->fields;
    summary["wall time"] = timings.all();
    for (const auto &model : models)
      {
        const OperatorSize size = model->op().size();
        json               entry;
        entry["unknowns"] = size.unknowns;
        if (size.bonds > 0)
          entry["bonds"] = size.bonds;
        entry["nonzeros"]              = size.nonzeros;
        entry["iterations"]            = model->n_iterations;
        entry["operator applications"] = model->op().n_applications();
        entry["operator form"]         = size.form;
        entry["settings"]              = json::object();
        for (const auto &[name, value] : model->settings())
          entry["settings"][name] = value;
        entry["wall time"] = model->timings.all();
        entry["memory"]    = Utilities::MPI::sum(static_cast<double>(size.memory), communicator);
        Utilities::System::MemoryStats stats;
        Utilities::System::get_memory_stats(stats);
        entry["peak memory"] =
          1024. * Utilities::MPI::sum(static_cast<double>(stats.VmHWM), communicator);
        entry.update(record->balances.at(model->name()));
        if (const json phases = describe_phases(*model, scene, record->totals, communicator);
            !phases.empty())
          entry["phases"] = phases;
        summary["models"][model->name()] = entry;
      }
    std::vector<std::pair<std::string, std::string>> files;
    if (!scene.output.probes.empty())
      files.emplace_back("probes.csv", probes.text());
    if (!scene.output.line.empty())
      files.emplace_back("line.csv", line.text());
    files.emplace_back("totals.csv", record->totals);
    files.emplace_back("scene.prm", scene_with_defaults());
    files.emplace_back("summary.json", json_text(summary));
    write_files(files, scene.general.output_directory, communicator);
  }


  template class ElasticSimulation<1>;
  template class ElasticSimulation<2>;
  template class ElasticSimulation<3>;
} // namespace PeriDeal
