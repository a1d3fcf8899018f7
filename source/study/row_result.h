// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <nlohmann/json.hpp>

#include "checked_row.h"

namespace PeriDeal
{
  /**
   * What has become of a row. Status and message are the same on all processes, the rest is on rank
   * 0 only.
   */
  struct RowResult
  {
    using Json = nlohmann::ordered_json;

    enum class Status
    {
      missing,
      finished,
      failed
    };

    Status      status = Status::missing;
    std::string message; // of the UserError that it ended with
    Json        record;  // the content of row.json: hash, status, times, memory
    Json results; // of a finished row: summary.json, and "totals" and "probes" from the tables

    /**
     * finished, failed, and with a row that should fail: failed as expected, did not fail. Empty if
     * missing.
     */
    std::string status_of(const StudyRow &row) const;

    /** Failed without being expected to, or the other way round. */
    bool is_wrong(const StudyRow &row) const;

    bool has_failed_as_it_may(const StudyRow &row) const;
  };

  /**
   * What the folder of a row holds of this very scene, program and number of processes, or a
   * missing result. Collective.
   */
  RowResult read_row(const CheckedRow &checked, const MPI_Comm communicator);

  /** How often a finished row has been computed. Rank 0 only; 0 elsewhere. */
  unsigned int repeats_of(const RowResult &result);

  /**
   * Compute a row @p repeats times, keep the smallest times, and write row.json. A UserError of all
   * processes is recorded; one that a process has met alone is recorded and thrown on. Collective.
   */
  RowResult compute_row(const CheckedRow  &checked,
                        const unsigned int repeats,
                        const MPI_Comm     communicator);
} // namespace PeriDeal
