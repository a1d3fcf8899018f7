// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <perideal/analysis/coupling_certificate.h>
#include <perideal/base/user_error.h>
#include <perideal/simulation/simulation.h>

#include <cmath>
#include <limits>
#include <sstream>

#include "result_record.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    using json = nlohmann::ordered_json;

    /** The comment paragraphs at the top of a scene file, without the comment marks. */
    std::string teaching_text(const std::string &text)
    {
      std::istringstream lines(text);
      std::string        line, result;
      while (std::getline(lines, line))
        {
          const std::size_t first = line.find_first_not_of(" \t");
          if (first == std::string::npos)
            {
              if (!result.empty())
                result += "\n";
              continue;
            }
          if (line[first] != '#')
            break;
          const std::size_t begin = line.find_first_not_of("# \t", first);
          const std::string words = begin == std::string::npos ? "" : line.substr(begin);
          if (words.rfind("SPDX", 0) == 0 || words.rfind("Copyright", 0) == 0)
            continue;
          result += words + "\n";
        }
      while (!result.empty() && result.back() == '\n')
        result.pop_back();
      return result;
    }


    template <int dim>
    std::vector<double> coordinates(const Point<dim> &p)
    {
      std::vector<double> list;
      for (unsigned int d = 0; d < dim; ++d)
        list.push_back(p[d]);
      return list;
    }


    /** Lowest and highest coordinates of the whole mesh. Collective. */
    template <int dim>
    std::pair<Point<dim>, Point<dim>> bounding_box(const Triangulation<dim> &mesh,
                                                   const MPI_Comm            communicator)
    {
      std::vector<double> lowest(2 * dim, std::numeric_limits<double>::max()), all(2 * dim);
      for (const auto &cell : mesh.active_cell_iterators())
        if (cell->is_locally_owned())
          for (const unsigned int v : cell->vertex_indices())
            for (unsigned int d = 0; d < dim; ++d)
              {
                lowest[d]       = std::min(lowest[d], cell->vertex(v)[d]);
                lowest[dim + d] = std::min(lowest[dim + d], -cell->vertex(v)[d]);
              }
      Utilities::MPI::min(lowest, communicator, all);
      std::pair<Point<dim>, Point<dim>> corners;
      for (unsigned int d = 0; d < dim; ++d)
        {
          corners.first[d]  = all[d];
          corners.second[d] = -all[dim + d];
        }
      return corners;
    }


    /** One sentence per side on what holds there. */
    template <int dim>
    json describe_sides(const Scene<dim> &scene)
    {
      const auto &conditions = scene.boundary_conditions;
      json        sides      = json::object();
      if (scene.domain.shape != Shape::mesh_file)
        for (unsigned int k = 0; k < 2 * dim; ++k)
          sides[box_side_names()[k]] = "insulated";
      const auto add = [&](const std::string &name, const std::string &text) {
        if (sides.contains(name) && sides[name] != "insulated")
          sides[name] = sides[name].template get<std::string>() + ", " + text;
        else
          sides[name] = text;
      };
      for (const SideCondition &c : conditions.dirichlet)
        add(c.name, "Dirichlet " + c.value.text());
      for (const SideCondition &c : conditions.flux)
        add(c.name,
            c.value.is_constant() && c.value.value(Point<dim>()) == 0. ? "insulated" :
                                                                         "flux " + c.value.text());
      for (const SideCondition &c : conditions.convection)
        add(c.name, "convection " + c.coefficient.text() + ", " + c.value.text());
      for (const auto side : conditions.symmetry)
        add(name_of_side(side, scene.domain.shape != Shape::mesh_file), "symmetry");
      return sides;
    }


    json describe_certificate(const CouplingCertificate &c)
    {
      json entry;
      entry["patch error"] = {{"linear", c.linear}, {"quadratic", c.quadratic}, {"cubic", c.cubic}};
      entry["asymmetry"]   = c.asymmetry;
      entry["lowest eigenvalue"] = c.lowest_eigenvalue;
      if (std::isfinite(c.lowest_remainder))
        entry["lowest eigenvalue of a cell"] = c.lowest_remainder;
      entry["share of the body"]             = c.zone_share;
      entry["share of the conductance kept"] = c.kept_share;
      entry["full peridynamics"]             = {{"bonds", c.n_bonds_of_full},
                                                {"nonzeros", c.n_nonzeros_of_full}};
      return entry;
    }


    template <int dim>
    json describe_model(const ModelRun<dim> &model,
                        const ResultRecord  &record,
                        const MPI_Comm       communicator)
    {
      const OperatorSize size = model.op().size();
      json               entry;
      entry["unknowns"] = size.unknowns;
      if (size.bonds > 0)
        entry["bonds"] = size.bonds;
      entry["nonzeros"] = size.nonzeros;
      if (size.busiest > 0.)
        entry["work of the busiest process"] = size.busiest;
      if (model.stepper)
        {
          entry["stepper"]        = model.stepper->name();
          entry["steps"]          = model.stepper->cost().steps;
          entry["rejected steps"] = model.stepper->cost().rejected;
          entry["iterations"]     = model.stepper->cost().iterations;
          if (model.stepper->current_step() > 0.)
            entry["time step"] = model.stepper->current_step();
          const Spectrum    spectrum = model.op().spectrum();
          const std::string method   = model.stepper->name() == "rk4" ? "rk4" : "euler";
          entry["stable step"]       = {{"sharp", stable_step(method, spectrum.sharp)},
                                        {"safe", stable_step(method, spectrum.safe)},
                                        {"method", method}};
        }
      else
        {
          entry["stepper"]    = "steady";
          entry["steps"]      = 0;
          entry["iterations"] = model.steady_iterations;
        }
      entry["operator applications"] = model.op().n_applications();
      entry["operator form"]         = size.form;
      json settings                  = json::object();
      for (const auto &[name, value] : model.settings())
        settings[name] = value;
      entry["settings"]  = settings;
      entry["wall time"] = model.timings.all();
      entry["memory"]    = Utilities::MPI::sum(static_cast<double>(size.memory), communicator);
      Utilities::System::MemoryStats stats;
      Utilities::System::get_memory_stats(stats);
      entry["peak memory"] =
        1024. * Utilities::MPI::sum(static_cast<double>(stats.VmHWM), communicator);
      if (const CouplingCertificate *certificate = model.examined())
        entry["certificate"] = describe_certificate(*certificate);
      if (record.errors.contains(model.name()))
        entry["errors"] = record.errors.at(model.name());
      entry.update(record.balances.at(model.name()));
      return entry;
    }
  } // namespace


  template <int dim>
  void Simulation<dim>::write_summary()
  {
    json summary;
    summary["title"]                  = scene.general.title;
    summary["text"]                   = teaching_text(text.text);
    summary["scene file"]             = text.file_name;
    summary["program"]                = std::string("PeriDeal ") + PERIDEAL_VERSION;
    summary["dimension"]              = dim;
    summary["processes"]              = Utilities::MPI::n_mpi_processes(communicator);
    summary["units"]                  = {{"length", scene.units.length},
                                         {"time", scene.units.time},
                                         {"temperature", scene.units.temperature},
                                         {"field", scene.units.of_field(scene.general.physics)}};
    const PhysicsNames &names         = names_of(scene.general.physics);
    summary["physics"]                = names.physics;
    summary["names"]                  = {{"field", names.field},
                                         {"flux", names.flux},
                                         {"content", names.content},
                                         {"flow", names.flow},
                                         {"quantity", names.quantity}};
    static const char *const shapes[] = {"box", "plate with hole", "mesh file"};
    const auto               corners  = bounding_box(*mesh, communicator);
    summary["domain"]                 = {{"lower", coordinates(corners.first)},
                                         {"upper", coordinates(corners.second)},
                                         {"shape", shapes[static_cast<int>(scene.domain.shape)]}};
    summary["cells"]                  = mesh->n_global_active_cells();
    if (scene.domain.coarsening > 0)
      summary["mesh"] = {{"coarsening", scene.domain.coarsening}, {"adaptations", n_adaptations}};
    summary["cracks"]      = corners_of(scene.cracks.pieces(scene.cracks.end_time));
    summary["sides"]       = describe_sides(scene);
    summary["steady"]      = scene.time.steady;
    summary["end time"]    = scene.time.steady ? 0. : scene.time.end_time;
    summary["write times"] = output_times();
    summary["reference"]   = scene.reference.solution;
    summary["notes"]       = record->notes;
    summary["fields"]      = record->fields;
    summary["wall time"]   = timings.all();
    summary["memory of mesh"] =
      Utilities::MPI::sum(static_cast<double>(mesh->memory_consumption()), communicator);
    for (const auto &model : models)
      summary["models"][model->name()] = describe_model(*model, *record, communicator);
    if (!record->comparison.empty())
      summary["comparison"] = record->comparison;
    if (!record->comparisons.empty())
      summary["comparisons"] = record->comparisons;

    std::string message;
    if (Utilities::MPI::this_mpi_process(communicator) == 0)
      try
        {
          const std::string directory = scene.general.output_directory + "/";
          if (!scene.output.probes.empty())
            write_file(directory + "probes.csv", probes->text());
          if (!scene.output.line.empty())
            write_file(directory + "line.csv", line->text());
          if (!scene.output.grid.empty())
            write_file(directory + "grid.csv", grid->text());
          write_file(directory + "totals.csv", record->totals);
          write_file(directory + "scene.prm", scene_with_defaults());
          write_file(directory + "summary.json",
                     summary.dump(2, ' ', false, json::error_handler_t::replace) + "\n");
        }
      catch (const UserError &error)
        {
          message = error.message();
        }
    throw_on_all_if_any(communicator, message);
  }

  template void Simulation<1>::write_summary();
  template void Simulation<2>::write_summary();
  template void Simulation<3>::write_summary();
} // namespace PeriDeal
