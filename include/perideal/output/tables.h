// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/archive.h>
#include <perideal/output/result_folder.h>

#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * A table (.csv) that is written as the run goes on: the rows of one time at once, so that a run
   * that ends early leaves whole lines. (The machine may cut the last one if it kills a run within
   * this very call.)
   */
  class Table
  {
  public:
    /**
     * The file exists with its header from now on. Writes where the folder does; failures are kept
     * there.
     *
     * @param goes_on it is that of a run that is resumed, and exchange() comes before rows
     */
    Table(ResultFolder      &folder,
          const std::string &name,
          const std::string &header,
          const bool         goes_on = false);
    ~Table();

    Table(const Table &)            = delete;
    Table &operator=(const Table &) = delete;

    /** @param rows whole lines */
    void add(const std::string &rows);

    /**
     * The length of the file. What has been added since it was saved goes when it is loaded; that
     * the file is shorter or gone is kept in the folder. Collective.
     */
    void exchange(Archive &archive);

    /** This process writes it. */
    bool writes() const
    {
      return file >= 0;
    }

  private:
    ResultFolder     &folder;
    const std::string name;
    int               file = -1; // -1 where nothing is written
  };


  /**
   * The rows `time,model,x,y,z,value` of probes.csv and line.csv, with other columns for other
   * physics; 15 significant digits, coordinates as given in the scene.
   */
  class PointTable
  {
  public:
    PointTable(ResultFolder                           &folder,
               const std::string                      &name,
               const std::vector<std::vector<double>> &points,
               const unsigned int                      dim,
               const std::vector<std::string>         &columns = {"value"},
               const bool                              goes_on = false);

    /** @param values those of all columns of the first point, then of the next */
    void add(const double time, const std::string &model, const std::vector<double> &values);

    /** As Table::exchange(). */
    void exchange(Archive &archive);

  private:
    std::vector<std::vector<double>> points;
    std::size_t                      n_columns;
    Table                            table;
  };

  /** The number with 15 significant digits. */
  std::string full_precision(const double x);
} // namespace PeriDeal
