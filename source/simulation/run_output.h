// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/output/crack_writer.h>
#include <perideal/problems/problem.h>
#include <perideal/problems/result_record.h>
#include <perideal/simulation/run_files.h>

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "point_readers.h"

namespace PeriDeal
{
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

    /** @param exact what is known of the solution, as of another model; or nullptr */
    void write_points(const double t, const ExactSolution *exact);

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
