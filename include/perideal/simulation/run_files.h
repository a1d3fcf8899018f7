// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/progress.h>
#include <perideal/output/checkpoints.h>
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
     * Takes the output directory and writes what is known at the start. A run that is resumed finds
     * the newest checkpoint and checks that it can go on from it before anything is written. Throws
     * UserError. Collective.
     */
    template <int dim>
    RunFiles(const Scene<dim> &scene,
             const SceneText  &text,
             const MPI_Comm    communicator,
             const RunMode     mode = RunMode::begin);

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
     * The run ends with an error: if it has results, which is returned, summary.json says how, and
     * @p more. Not collective, since a process may have failed alone.
     */
    bool end_early(const std::string &message, const bool diverged, const Json &more);

    /** The checkpoint to go on from, until has_resumed(); null in a run that begins. */
    CheckpointReader *checkpoint() const
    {
      return reader.get();
    }

    /** All has been loaded: the run has results, and lets go of the checkpoint. */
    void has_resumed();

    /**
     * Keep the state of the run, which @p save hands over. Returns why it could not be written, a
     * sentence, empty if it could; then the run has results.
     *
     * @param time      simulated
     * @param wall_time of the whole run, in seconds
     *
     * Collective.
     */
    std::string write_checkpoint(const double                          time,
                                 const double                          wall_time,
                                 const std::function<void(Archive &)> &save);

    /** The last checkpoint that was written, with its folder; empty if there is none. */
    std::string last_checkpoint() const;

    /** Summary and totals. Throws UserError where a file cannot be gone on with. Collective. */
    void exchange(Archive &archive);

    ResultFolder             folder;
    std::vector<std::string> notes; // on checkpoints that could not be taken

  private:
    using Clock = std::chrono::steady_clock;

    const MPI_Comm   communicator;
    CheckpointHeader header; // of this run
    Checkpoints      checkpoints;

    std::unique_ptr<CheckpointReader> reader;

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
