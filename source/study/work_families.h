// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/study/lattice_ladder.h>
#include <perideal/study/study_file.h>

#include <string>
#include <vector>

namespace PeriDeal
{
  /** A method with its settings, to be computed on several lattices. */
  struct WorkFamily
  {
    std::string          name;
    std::string          model; // as in output files
    std::vector<Setting> settings;
    double               ratio    = 0.;    // m of peridynamics in the whole body, else 0
    bool                 on_faces = false; // needs lattices with the cracks on cell faces
    unsigned int         multiple = 1;     // of the numbers of cells
    bool                 deforms  = false; // for bodies that deform, else for what diffuses
  };

  /** All methods that are compared, in the order of tables and legends. */
  const std::vector<WorkFamily> &work_families();

  /** What is computed of a scene, and what is not, with the reason. */
  struct WorkPlan
  {
    struct Row
    {
      std::string       name;
      const WorkFamily *family; // null for the reference
      CellCounts        cells;
    };
    std::vector<CellCounts>  ladder, reference; // no reference lattices: the scene has a solution
    std::vector<Row>         rows;              // the reference first
    std::vector<std::string> left_out;          // sentences
  };

  /**
   * The plan for a box with cracks.
   *
   * @param deforms the body deforms, else something diffuses in it
   * @param exact the scene has a reference solution
   * @param cells, reference as of WorkPrecisionOptions
   *
   * Throws UserError.
   */
  WorkPlan plan_work(const CrackedBox  &box,
                     const bool         deforms,
                     const bool         exact,
                     const bool         moving_cracks,
                     const std::string &cells,
                     const std::string &reference,
                     const double       budget);
} // namespace PeriDeal
