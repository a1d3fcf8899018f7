// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/study/lattice_ladder.h>

#include "work_families.h"

namespace PeriDeal
{
  /** What the study has to know of a scene. */
  struct WorkScene
  {
    std::string title;
    CrackedBox  box;
    Comparison  comparison    = Comparison::cracks;
    bool        exact         = false; // it has a reference solution
    bool        moving_cracks = false, steady = true;
    bool        given_zone = false; // by a formula
    double      wave_speed = 0.;    // of a bar in the middle of the box; motion only
    std::string no_choice;          // why `Models = auto` does not choose for it; empty: it does
  };

  /** In what errors are measured. */
  enum class WorkMeasure
  {
    field,           // all values
    opening,         // the displacement of the right side of cracks against that of the
                     // left
    stress_intensity // of both modes at all ends of cracks
  };

  /** Throws UserError for other words. */
  WorkMeasure parse_measure(const std::string &text);

  /** What is computed of a scene, and what is not, with the reason. */
  struct WorkPlan
  {
    enum class Role
    {
      reference,
      method,
      pick,          // by `Models = auto`: what it costs
      pick_values,   // the same, with the values that are compared: to read them takes long
      exact_in_time, // the same in space, with hardly an error in time
      in_time        // of it only the error in time counts
    };
    struct Row
    {
      std::string          name;
      Role                 role;
      const WorkFamily    *family; // null for the reference and for picks
      CellCounts           cells;  // of a pick: on whose vertices it is compared
      std::vector<Setting> settings;
      std::string          stepper;        // in_time
      double               tolerance = 0.; // of a pick, or of a stepper that adapts its steps
    };
    std::vector<CellCounts> ladder,
      reference;                       // no reference lattices: the scene has a solution
    std::vector<Row>         rows;     // the reference first
    std::vector<std::string> left_out; // sentences
    std::string              no_picks; // why there are none, if there are none
    WorkMeasure              measure = WorkMeasure::field;
    std::string              probes; // opening: points right and left of cracks by turns
  };

  /** What the reader asks for, as of WorkPrecisionOptions. */
  struct WorkWishes
  {
    std::string cells, reference;
    double      budget  = 2e6;
    bool        picks   = true;
    WorkMeasure measure = WorkMeasure::field;
  };

  /** The plan for a scene in a box. Throws UserError. */
  WorkPlan plan_work(const WorkScene &scene, const WorkWishes &wishes);
} // namespace PeriDeal
