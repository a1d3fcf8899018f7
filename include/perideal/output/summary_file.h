// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/archive.h>
#include <perideal/output/result_folder.h>

#include <nlohmann/json.hpp>

#include <string>

namespace PeriDeal
{
  /**
   * summary.json from the start of a run to its end. Its entry `status` is `running` until the run
   * says how it ended; a run that is killed leaves that, one that is told to end (SIGTERM, SIGINT)
   * leaves `stopped` and what the last update() knew. Rank 0 writes; nothing here is collective.
   */
  class SummaryFile
  {
  public:
    using Json = nlohmann::ordered_json;

    /**
     * @param start   what is known before anything is computed
     * @param goes_on the file is that of a run that is resumed, and stays until exchange()
     */
    SummaryFile(ResultFolder &folder, const Json &start, const bool goes_on = false);

    /** The process needs no farewell any more. */
    ~SummaryFile();

    /**
     * @param summary what is known now @param reached how far the run is, as it reads after
     *                "Results"
     */
    void update(const Json &summary, const std::string &reached);

    /** A checkpoint has been written, which a process that is told to end names. */
    void note_checkpoint(const std::string &file);

    void complete(const Json &summary);

    /** The run ends early. @param status `diverged` or `stopped` @param more of why, behind both */
    void end(const std::string &status, const std::string &message, const Json &more);

    /** What is known. When it is loaded the file says that the run goes on. Collective. */
    void exchange(Archive &archive);

  private:
    void prepare_farewell() const;

    ResultFolder &folder;
    Json          known;
    std::string   reached, checkpoint;
  };
} // namespace PeriDeal
