// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/study/study_file.h>

namespace PeriDeal
{
  /** How a study is to be computed. */
  struct StudyOptions
  {
    bool                     quiet = false; // print nothing but errors
    bool                     redo  = false; // compute finished rows again
    bool                     quick = false; // rows marked quick only
    std::vector<std::string> only;        // rows of these names, sweeps or groups only; empty: all
    unsigned int             repeats = 1; // run each row so often and keep the smallest times
  };


  /**
   * Compute the rows of a study one after the other in this program, each into `rows/<folder>` of
   * the study's output directory, and rewrite `study.csv` and `study.json` there after every row.
   *
   * All rows' scenes are parsed before the first is computed. A row is kept if its folder holds the
   * results of the same scene, settings and program, computed with the same number of processes and
   * no fewer repeats (row.json says). A row that ends with a UserError is recorded as failed and
   * the study goes on; if one process alone fails, the others cannot be brought back and the study
   * ends.
   *
   * Throws UserError: mistakes in the study or a scene, and at the end if rows failed (or did not,
   * although they should). Collective.
   */
  void run_study(const Study &study, const StudyOptions &options, const MPI_Comm communicator);
} // namespace PeriDeal
