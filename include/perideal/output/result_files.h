// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <mpi.h>

#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * Make the output directory (with its `fields` folder) and take away the results of an earlier run, so that a run that fails leaves
   * none behind that could be taken for its own; other files stay. Throws UserError on all processes if the directory cannot be written, or
   * if the run would write over its own scene file there. Collective.
   */
  void prepare_directory(const std::string &directory,
                         const std::string &scene_file,
                         const MPI_Comm     communicator);

  /** Write a file whole or not at all (new file, then rename). Call it on one process. */
  void write_file(const std::string &name, const std::string &text);

  /**
   * The rows `time,model,x,y,z,value` of probes.csv and line.csv, with other columns for other physics. Rows are collected and written by rank 0 at save(); 15 significant
   * digits, coordinates as given in the scene.
   */
  class PointTable
  {
  public:
    PointTable(const std::vector<std::vector<double>> &points,
               const unsigned int                      dim,
               const std::vector<std::string>         &columns = {"value"});

    /** @param values those of all columns of the first point, then of the next */
    void add(const double time, const std::string &model, const std::vector<double> &values);

    std::string text() const;

  private:
    std::vector<std::vector<double>> points;
    std::size_t                      n_columns;
    std::string                      rows, header;
  };

  /** The number with 15 significant digits. */
  std::string full_precision(const double x);
} // namespace PeriDeal
