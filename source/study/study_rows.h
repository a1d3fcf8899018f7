// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/study/study.h>

#include <vector>

#include "row_result.h"

namespace PeriDeal
{
  /** All rows of a study, which of them were asked for, and what has become of each. */
  struct ComputedStudy
  {
    std::vector<CheckedRow> rows;
    std::vector<bool>       selected;
    std::vector<RowResult>  results;
  };

  /**
   * What run_study() does, but for the UserError about rows that did not end as they should.
   * Collective.
   */
  ComputedStudy compute_study(const Study        &study,
                              const StudyOptions &options,
                              const MPI_Comm      communicator);

  /**
   * Throws the UserError that lists the rows that did not end as they should. Not collective: all
   * processes know.
   */
  void throw_if_wrong(const Study &study, const ComputedStudy &computed);

  /** One line for the reader, on rank 0 and unless quiet. */
  void print_line(const MPI_Comm communicator, const bool quiet, const std::string &text);
} // namespace PeriDeal
