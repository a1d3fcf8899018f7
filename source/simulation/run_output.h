// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/analysis/point_evaluator.h>
#include <perideal/output/crack_writer.h>
#include <perideal/problems/problem.h>
#include <perideal/problems/result_record.h>
#include <perideal/simulation/run_files.h>

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

namespace PeriDeal
{
  template <int dim>
  using PointReaders = std::vector<std::unique_ptr<PointEvaluator<dim>>>;


  /**
   * One for each model, or none without points. @p entry names the points in messages; those of a
   * `Line` may lie outside the body. @param beside as PointEvaluator has it. Collective.
   */
  template <int dim, typename Models>
  PointReaders<dim> make_point_readers(const Models                                    &models,
                                       const Cracks<dim>                               &cracks,
                                       const std::vector<std::vector<double>>          &points,
                                       const std::string                               &entry,
                                       const typename PointEvaluator<dim>::BesideCracks beside)
  {
    using Outside = typename PointEvaluator<dim>::Outside;
    PointReaders<dim> readers;
    if (!points.empty())
      for (const auto &model : models)
        readers.push_back(std::make_unique<PointEvaluator<dim>>(
          model->dofs(),
          model->nodes(),
          cracks,
          points,
          entry,
          entry == "Line" ? Outside::leave_gaps : Outside::refuse,
          beside));
    return readers;
  }


  /** A note on the points of a line that are not in the body, or nothing. */
  template <int dim>
  std::vector<std::string> gaps_in_line(const PointReaders<dim>                &readers,
                                        const std::vector<std::vector<double>> &points)
  {
    std::vector<unsigned int> outside;
    for (unsigned int k = 0; k < points.size(); ++k)
      if (std::any_of(readers.begin(), readers.end(), [&](const auto &reader) {
            return reader->is_gap(k);
          }))
        outside.push_back(k);
    if (outside.empty())
      return {};
    const auto place = [&](const unsigned int k) {
      std::ostringstream text;
      for (const double x : points[k])
        text << (text.tellp() > 0 ? ", " : "(") << x;
      return text.str() + ")";
    };
    const std::string n =
      std::to_string(outside.size()) + " of its " + std::to_string(points.size()) + " points ";
    return {"'Line' in section 'Output': " +
            (outside.size() == 1 ?
               n + "lies outside the body, " + place(outside[0]) :
               n + "lie outside the body, the first at " + place(outside.front()) +
                 ", the last at " + place(outside.back())) +
            ". They have no values: nan in line.csv, gaps in figures."};
  }


  /**
   * What a run writes, whatever it computes: values at points, fields, rows of totals, and what is
   * collected for the summary. Files of results begin with the first of each kind. All functions
   * are collective.
   */
  template <int dim>
  class RunOutput
  {
  public:
    using Problems = std::vector<const Problem<dim> *>;

    /** Nothing is written before open(). Scene and record have to outlive this object. */
    RunOutput(const Scene<dim> &scene, ResultRecord &record);

    /** Takes the output directory. Throws UserError. */
    void open(const SceneText &text,
              const MPI_Comm   communicator,
              const RunMode    mode = RunMode::begin);
    bool is_open() const;
    void close();

    /** In place of open(): the files of a run that has begun. */
    void adopt(std::unique_ptr<RunFiles> files);

    /**
     * Find where the points of the output lie in the meshes of the problems, which are those of all
     * later calls. Throws UserError where a point lies outside of the body.
     */
    void find_points(const Problems &problems);

    /** Notes on what of the line lies outside the body, or nothing. */
    std::vector<std::string> gaps_in_line() const;

    /**
     * @param exact what is known of the solution, as of another model; or nullptr
     * @param all   else probes alone
     */
    void write_points(const double t, const ExactSolution *exact, const bool all = true);

    /** @param more fields, by the name of the model */
    void write_fields(const double t, const std::map<std::string, OutputField> &more = {});

    /** All of a time has been written. @param summary and @param reached as RunFiles' */
    void end_time(const std::function<RunFiles::Json()> &summary, const std::string &reached);

    /** The run is complete. */
    void complete(const RunFiles::Json &summary);

    RunFiles &files();

    /**
     * What has been written and the record of it, so that a run that is resumed goes on with the
     * same files. After find_points(). Throws UserError where a file is gone.
     */
    void exchange(Archive &archive);

  private:
    struct PointOutput
    {
      std::string                             entry, file;
      const std::vector<std::vector<double>> &points;
      PointReaders<dim>                       readers; // of the problems
      std::unique_ptr<PointTable>             table;
    };

    void write(PointOutput &output, const double t, const ExactSolution *exact);
    void make_table(PointOutput &output, const bool goes_on);
    void make_writer();
    void make_crack_writers();

    const Scene<dim>                              &scene;
    ResultRecord                                  &record;
    std::unique_ptr<RunFiles>                      run_files;
    Problems                                       problems;
    std::vector<PointOutput>                       outputs;
    std::vector<std::unique_ptr<FieldWriter<dim>>> writers;
    std::unique_ptr<CrackWriter>                   cracks;     // of the scene
    std::vector<std::unique_ptr<CrackWriter>>      new_cracks; // that problems have found
  };
} // namespace PeriDeal
