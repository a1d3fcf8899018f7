// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/study/study.h>

namespace PeriDeal
{
  /** What accuracy is charted against cost for. */
  struct WorkPrecisionOptions
  {
    std::string              scene;
    std::vector<std::string> overrides;      // "Section/Entry=value", of all rows
    std::string              cells;          // "21, 21 | 41, 41"; empty: from the scene's `Cells`
    std::string              reference;      // three lattices for the reference; empty: chosen here
    double                   budget  = 2e6;  // bonds of peridynamics in the whole body
    bool                     picks   = true; // mark what `Models = auto` chooses
    std::string              measure = "field"; // opening, stress intensity
    std::string              output;            // empty: output/studies/<scene>_work_precision
    StudyOptions             study;
  };


  /**
   * Compute a scene by many methods on several lattices, as rows of a study, and find for each what
   * it costs and how wrong it is: `work_precision.csv` and `work_precision.json` in the output
   * directory, beside the files of the study. What `Models = auto` chooses for errors of 3e-2, 1e-2
   * and 1e-3 is compared in the same way; of what changes in time one method is computed with all
   * steppers, too.
   *
   * The error is that of the nodal values, against `Reference/Solution` or, without one, against
   * finite elements, with cracks on cell faces, on three fine lattices, extrapolated. Cost is the
   * number of nonzeros that are applied times the number of applications of the operator. Of bodies
   * with cracks the openings of the cracks or the stress intensities may be measured instead.
   *
   * Throws UserError, among others: no box, no reference to be had.
   * Collective.
   */
  void run_work_precision(const WorkPrecisionOptions &options, const MPI_Comm communicator);
} // namespace PeriDeal
