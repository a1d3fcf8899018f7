// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/progress.h>
#include <perideal/output/summary_file.h>
#include <perideal/output/tables.h>
#include <perideal/scene/scene.h>

#include <chrono>
#include <exception>
#include <functional>
#include <string>

namespace PeriDeal
{
  /**
   * The files of a run of any physics, fields apart, from its start to its end: the scene as used,
   * totals.csv, summary.json with its status. Until the first results the output directory can
   * still go back to what it held before.
   */
  class RunFiles
  {
  public:
    using Json = nlohmann::ordered_json;

    /**
     * Takes the output directory and writes what is known at the start. Throws UserError.
     * Collective.
     */
    template <int dim>
    RunFiles(const Scene<dim> &scene, const SceneText &text, const MPI_Comm communicator);

    /**
     * Rows for totals.csv, after all other output of that time; with them, unless anything could
     * not be written, the run has results. Collective.
     */
    void add_totals(const std::string &rows);

    /**
     * After output: throws what could not be written, and refreshes summary.json from time to time,
     * so that this costs little. @param summary builds it, collectively; @param reached how far the
     * run is. Collective.
     */
    void after_output(const std::function<Json()> &summary, const std::string &reached);

    /** The run is complete. Collective. */
    void complete(const Json &summary);

    /**
     * The run ends with an error: if it has results, which is returned, summary.json says how. Not
     * collective, since a process may have failed alone.
     */
    bool end_early(const std::string &message, const bool diverged);

    ResultFolder folder;

  private:
    using Clock = std::chrono::steady_clock;

    const MPI_Comm    communicator;
    SummaryFile       summary_file;
    Table             totals;
    bool              has_results = false;
    Clock::time_point last_update;
    Clock::duration   cost_of_update{0};
  };


  /**
   * Do it, and if it throws, end the files of the run accordingly and tell where results are; the
   * error goes on.
   */
  void with_orderly_end(RunFiles                    &files,
                        const Progress              &progress,
                        const std::function<void()> &action);
} // namespace PeriDeal
