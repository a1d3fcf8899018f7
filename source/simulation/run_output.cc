// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "run_output.h"

#include <perideal/base/instantiate.h>

#include <cmath>
#include <utility>

#include "summary_parts.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  RunOutput<dim>::RunOutput(const Scene<dim> &scene, ResultRecord &record)
    : scene(scene)
    , record(record)
  {
    const auto add = [this](const std::string                      &entry,
                            const std::string                      &file,
                            const std::vector<std::vector<double>> &points) {
      outputs.push_back({entry, file, points, {}, nullptr});
    };
    add("Probes", "probes.csv", scene.output.probes);
    add("Line", "line.csv", scene.output.line);
    add("Grid", "grid.csv", scene.output.grid);
  }


  template <int dim>
  void RunOutput<dim>::open(const SceneText &text, const MPI_Comm communicator, const RunMode mode)
  {
    run_files = std::make_unique<RunFiles>(scene, text, communicator, mode);
  }


  template <int dim>
  bool RunOutput<dim>::is_open() const
  {
    return run_files != nullptr;
  }


  template <int dim>
  void RunOutput<dim>::adopt(std::unique_ptr<RunFiles> files)
  {
    run_files = std::move(files);
  }


  template <int dim>
  void RunOutput<dim>::close()
  {
    run_files.reset();
  }


  template <int dim>
  RunFiles &RunOutput<dim>::files()
  {
    return *run_files;
  }


  template <int dim>
  void RunOutput<dim>::find_points(const Problems &of_run)
  {
    using Beside        = typename PointEvaluator<dim>::BesideCracks;
    const Beside beside = scene.general.automatic ? Beside::own_side : Beside::interpolate;
    problems            = of_run;
    for (PointOutput &output : outputs)
      output.readers =
        make_point_readers<dim>(problems, scene.cracks, output.points, output.entry, beside);
  }


  template <int dim>
  std::vector<std::string> RunOutput<dim>::gaps_in_line() const
  {
    for (const PointOutput &output : outputs)
      if (output.entry == "Line")
        return PeriDeal::gaps_in_line<dim>(output.readers, output.points);
    return {};
  }


  template <int dim>
  void RunOutput<dim>::write_points(const double t, const ExactSolution *exact, const bool all)
  {
    for (PointOutput &output : outputs)
      if (!output.points.empty() && (all || output.entry == "Probes"))
        write(output, t, exact);
  }


  template <int dim>
  void RunOutput<dim>::make_table(PointOutput &output, const bool goes_on)
  {
    output.table = std::make_unique<PointTable>(run_files->folder,
                                                output.file,
                                                output.points,
                                                dim,
                                                problems[0]->columns(),
                                                goes_on);
  }


  template <int dim>
  void RunOutput<dim>::write(PointOutput &output, const double t, const ExactSolution *exact)
  {
    if (!output.table)
      make_table(output, false);
    for (std::size_t k = 0; k < problems.size(); ++k)
      output.table->add(t,
                        problems[k]->name(),
                        problems[k]->at_points(*output.readers[k], output.points));
    if (!exact)
      return;
    std::vector<double> values;
    for (unsigned int k = 0; k < output.points.size(); ++k)
      {
        Point<dim> point;
        for (unsigned int d = 0; d < dim; ++d)
          point[d] = output.points[k][d];
        const std::vector<double> row = problems[0]->exact_row(*exact, point, t);
        for (const double value : row)
          values.push_back(output.readers[0]->is_gap(k) ? std::nan("") : value);
      }
    output.table->add(t, "exact", values);
  }


  template <int dim>
  void RunOutput<dim>::make_writer()
  {
    const Problem<dim> &problem = *problems[writers.size()];
    writers.push_back(std::make_unique<FieldWriter<dim>>(problem.dofs(),
                                                         run_files->folder,
                                                         series_of(problem.name()),
                                                         problem.shown()));
  }


  template <int dim>
  void RunOutput<dim>::make_crack_writers()
  {
    cracks = std::make_unique<CrackWriter>(run_files->folder, "cracks");
    for (const Problem<dim> *const problem : problems)
      new_cracks.push_back(
        std::make_unique<CrackWriter>(run_files->folder, "cracks_" + series_of(problem->name())));
  }


  template <int dim>
  void RunOutput<dim>::write_fields(const double t, const std::map<std::string, OutputField> &more)
  {
    if (!scene.output.vtu && !scene.output.hdf5)
      return;
    RunFiles::Json names = RunFiles::Json::object();
    for (std::size_t k = 0; k < problems.size(); ++k)
      {
        const std::string model = problems[k]->name();
        if (writers.size() == k)
          make_writer();
        std::vector<OutputField> fields = problems[k]->fields(t);
        if (const auto found = more.find(model); found != more.end())
          fields.push_back(found->second);
        const std::string name = writers[k]->write(fields, t, scene.output.vtu, scene.output.hdf5);
        if (!name.empty())
          names[model] = name;
      }
    record.fields.push_back({{"time", t}, {"files", names}});
    if (scene.cracks.change())
      record.fields.back()["cracks"] = corners_of(scene.cracks.pieces(t));
    if (!cracks)
      make_crack_writers();
    if (!scene.output.vtu)
      return;
    cracks->write({crack_corners(scene.cracks.pieces(t)), {}}, t);
    for (std::size_t k = 0; k < problems.size(); ++k)
      new_cracks[k]->write(problems[k]->new_cracks(), t);
  }


  template <int dim>
  void RunOutput<dim>::end_time(const std::function<RunFiles::Json()> &summary,
                                const std::string                     &reached)
  {
    const std::string rows = std::exchange(record.totals, "");
    if (!run_files) // solved alone, without results
      return;
    run_files->add_totals(rows);
    run_files->after_output(summary, reached);
  }


  template <int dim>
  void RunOutput<dim>::complete(const RunFiles::Json &summary)
  {
    run_files->add_totals(std::exchange(record.totals, ""));
    run_files->complete(summary);
  }


  template <int dim>
  void RunOutput<dim>::exchange(Archive &archive)
  {
    const Archive::Part part(archive, "output");
    run_files->exchange(archive);
    record.exchange(archive);
    for (PointOutput &output : outputs)
      {
        const Archive::Part of_file(archive, output.file);
        bool                has_table = output.table != nullptr;
        archive.exchange("exists", has_table);
        if (has_table && !output.table)
          make_table(output, true);
        if (has_table)
          output.table->exchange(archive);
      }
    unsigned int n_writers = writers.size();
    archive.exchange("number of field writers", n_writers);
    while (writers.size() < n_writers)
      make_writer();
    for (const auto &writer : writers)
      writer->exchange(archive);
    bool has_cracks = cracks != nullptr;
    archive.exchange("has cracks", has_cracks);
    if (has_cracks && !cracks)
      make_crack_writers();
    if (has_cracks)
      cracks->exchange(archive);
    for (const auto &writer : new_cracks)
      writer->exchange(archive);
    run_files->folder.check();
  }


  PERIDEAL_INSTANTIATE_CLASS(class RunOutput);
} // namespace PeriDeal
