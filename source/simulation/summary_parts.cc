// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "summary_parts.h"

#include <deal.II/base/mpi.h>
#include <deal.II/base/utilities.h>

#include <perideal/base/instantiate.h>
#include <perideal/problems/check_sides.h>
#include <perideal/problems/problem_factory.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace PeriDeal
{
  using namespace dealii;

  using json = nlohmann::ordered_json;

  namespace
  {
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
    json describe_image(const std::string &file_name, const PhaseMap &map)
    {
      json       phases = json::object();
      const auto counts = map.counts();
      for (std::size_t k = 0; k < counts.size(); ++k)
        if (k < map.names.size() || counts[k] > 0)
          phases[k < map.names.size() ? map.names[k] : void_name] = {
            {"cells", counts[k]},
            {"area fraction", static_cast<double>(counts[k]) / map.phases.size()},
            {"color", {map.colors[k][0], map.colors[k][1], map.colors[k][2]}}};
      return {{"file", file_name}, {"cells", map.n_cells}, {"phases", phases}};
    }
  } // namespace


  template <int dim>
  json describe_start(const Scene<dim> &scene, const SceneText &text, const MPI_Comm communicator)
  {
    json summary;
    summary["title"]      = scene.general.title;
    summary["text"]       = teaching_text(text.text);
    summary["scene file"] = text.file_name;
    summary["program"]    = std::string("PeriDeal ") + PERIDEAL_VERSION;
    summary["dimension"]  = dim;
    summary["processes"]  = Utilities::MPI::n_mpi_processes(communicator);
    describe_physics(scene, summary);
    summary["models"] = json::object();
    summary["fields"] = json::array();
    return summary;
  }


  template <int dim>
  json describe_scene(const Scene<dim>         &scene,
                      const SceneText          &text,
                      const Triangulation<dim> &mesh,
                      const MPI_Comm            communicator)
  {
    json                     summary  = describe_start(scene, text, communicator);
    static const char *const shapes[] = {"box", "plate with hole", "mesh file", "image", "generator"};
    const auto               corners =
      scene.domain.has_extra_layers() ?
                      std::make_pair(scene.domain.extra.body_lower, scene.domain.extra.body_upper) :
                      bounding_box(mesh, communicator);
    summary["domain"] = {{"lower", coordinates(corners.first)},
                         {"upper", coordinates(corners.second)},
                         {"shape", shapes[static_cast<int>(scene.domain.shape)]}};
    summary["cells"]  = mesh.n_global_active_cells();
    if (json places = places_of_conditions(scene, mesh, communicator); !places.empty())
      summary["places"] = std::move(places);
    if (scene.domain.image)
      summary["image"] = describe_image(scene.domain.files.image, scene.domain.image_of_body());
    return summary;
  }


  template <int dim>
  void describe_run(const Scene<dim>         &scene,
                    const Triangulation<dim> &mesh,
                    const ResultRecord       &record,
                    const Timings            &timings,
                    json                     &summary)
  {
    summary["cracks"]    = corners_of(scene.cracks.pieces(scene.cracks.end_time));
    summary["steady"]    = scene.time.steady;
    summary["end time"]  = scene.time.steady ? 0. : scene.time.end_time;
    summary["notes"]     = record.notes;
    summary["fields"]    = record.fields;
    summary["wall time"] = timings.all();
    summary["memory of mesh"] =
      Utilities::MPI::sum(static_cast<double>(mesh.memory_consumption()), mesh.get_communicator());
    if (!record.comparison.empty())
      summary["comparison"] = record.comparison;
    if (!record.comparisons.empty())
      summary["comparisons"] = record.comparisons;
  }


  template <int dim>
  json describe_problem(const Problem<dim> &problem, const json &own, const ResultRecord &record)
  {
    const MPI_Comm     communicator = problem.dofs().get_communicator();
    const OperatorSize size         = problem.op().size();
    json               entry;
    entry["unknowns"] = size.unknowns;
    if (size.bonds > 0)
      entry["bonds"] = size.bonds;
    entry["nonzeros"] = size.nonzeros;
    if (size.busiest > 0.)
      entry["work of the busiest process"] = size.busiest;
    entry.update(own);
    entry["operator applications"] = problem.op().n_applications();
    entry["operator form"]         = size.form;
    entry["settings"]              = json::object();
    for (const auto &[name, value] : problem.settings())
      entry["settings"][name] = value;
    if (const CouplingCertificate *certificate = problem.examined())
      entry["certificate"] = describe_certificate(*certificate);
    entry["wall time"] = problem.timings.all();
    entry["memory"]    = Utilities::MPI::sum(static_cast<double>(size.memory), communicator);
    Utilities::System::MemoryStats stats;
    Utilities::System::get_memory_stats(stats);
    entry["peak memory"] =
      1024. * Utilities::MPI::sum(static_cast<double>(stats.VmHWM), communicator);
    if (record.errors.contains(problem.name()))
      entry["errors"] = record.errors.at(problem.name());
    for (const json *const results : {&record.balances, &record.extremes})
      if (results->contains(problem.name()) && results->at(problem.name()).is_object())
        entry.update(results->at(problem.name())); // null without any force
    return entry;
  }


  template <int dim>
  void write_image_as_read(const Scene<dim> &scene, ResultFolder &folder)
  {
    if (scene.domain.image)
      folder.write("image_as_read.png", encode_png(scene.domain.image_of_body().picture()));
  }


  std::string series_of(const std::string &model)
  {
    std::string series = model;
    std::replace(series.begin(), series.end(), ' ', '_');
    return series;
  }


  json describe_certificate(const CouplingCertificate &c)
  {
    json entry;
    entry["patch error"] = {{"linear", c.linear}, {"quadratic", c.quadratic}, {"cubic", c.cubic}};
    entry["asymmetry"]   = c.asymmetry;
    if (c.unbalanced)
      entry["unbalanced forces"] = *c.unbalanced;
    entry["lowest eigenvalue"] = c.lowest_eigenvalue;
    if (std::isfinite(c.lowest_remainder))
      entry["lowest eigenvalue of a cell"] = c.lowest_remainder;
    entry["share of the body"] = c.zone_share;
    entry[c.unbalanced ? "share of the stiffness kept" : "share of the conductance kept"] =
      c.kept_share;
    entry["full peridynamics"] = {{"bonds", c.n_bonds_of_full}};
    if (c.n_nonzeros_of_full > 0)
      entry["full peridynamics"]["nonzeros"] = c.n_nonzeros_of_full;
    return entry;
  }


  std::string certificate_line(const CouplingCertificate &c)
  {
    std::ostringstream text;
    text.precision(3);
    text << "  coupling: " << 100. * c.zone_share << " % of the body; patch errors ";
    text.precision(2);
    text << c.linear << " (linear), " << c.quadratic << " (quadratic), " << c.cubic << " (cubic)";
    return text.str();
  }


  template <int dim>
  void say_size(const Problem<dim> &problem, const Progress &progress)
  {
    const OperatorSize size = problem.op().size();
    std::string        line = problem.name() + ": " + readable_count(size.unknowns) + " unknowns";
    if (size.bonds > 0)
      line += ", " + readable_count(size.bonds) + " bonds";
    if (size.nonzeros > 0)
      line += ", " + readable_count(size.nonzeros) +
              (size.form == "lattice" && problem.n_components() == 1 ? " stored corrections" :
                                                                       " stored numbers");
    const double memory =
      Utilities::MPI::sum(static_cast<double>(size.memory), problem.dofs().get_communicator());
    progress.line(line + ", " + readable_bytes(memory));
    for (const auto &[name, value] : problem.settings())
      if (name == "operator form")
        progress.line("  form: " + value);
      else if (name == "law")
        progress.line("  law: " + value);
      else if (name == "calibration" && value.find("because") != std::string::npos)
        progress.line("  calibration: " + value);
    if (const CouplingCertificate *certificate = problem.examined())
      progress.line(certificate_line(*certificate));
  }


  PERIDEAL_INSTANTIATE_FUNCTION(describe_scene);
  PERIDEAL_INSTANTIATE_FUNCTION(describe_start);
  PERIDEAL_INSTANTIATE_FUNCTION(write_image_as_read);
  PERIDEAL_INSTANTIATE_FUNCTION(describe_run);
  PERIDEAL_INSTANTIATE_FUNCTION(describe_problem);
  PERIDEAL_INSTANTIATE_FUNCTION(say_size);
} // namespace PeriDeal
