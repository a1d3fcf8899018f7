// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/study/pareto.h>

#include <limits>
#include <optional>

#include "study_rows.h"
#include "work_plan.h"

namespace PeriDeal
{
  /** What a finished row has cost, and how wrong it is. */
  struct WorkRow
  {
    std::string        name, form;
    const WorkFamily  *family = nullptr;
    CellCounts         cells;
    double             spacing  = 0.; // the largest of the directions
    unsigned long long unknowns = 0, bonds = 0, nonzeros = 0, applied = 0, iterations = 0,
                       applications = 0;
    double work = 0., error = 0.;
    double set_up = 0., solve = 0., wall_time = 0.; // smallest of all repeats
    double memory = 0., peak_memory = 0.;
  };

  /** Solutions on three lattices and what they say about their limit. */
  struct WorkReference
  {
    bool   exact          = true;
    bool   cracked        = true; // the cracks lie on cell faces; else of degree 2
    double observed_order = std::numeric_limits<double>::quiet_NaN(), order = 0.;
    double own_error = 0.; // of the extrapolated solution, relative like all errors
  };

  /** What `Models = auto` has chosen, what it has cost, and how wrong it really is. */
  struct WorkPick
  {
    std::string name;
    double      tolerance = 0., error = 0., estimate = 0.;
    double      wall_time = 0.; // of the whole run, with all tries
    bool        met       = false;
    std::size_t tries     = 0;
    std::string model;
    std::string settings; // "Cells = 16, 16; Degree = 2"
  };

  /** A stepper with its tolerance on one lattice, against the same with hardly an error in time. */
  struct TimeRow
  {
    std::string        name, stepper;
    double             tolerance = 0.; // 0: fixed steps, the largest that are stable
    unsigned long long steps = 0, iterations = 0, applications = 0;
    double             work = 0., error = 0., wall_time = 0.;
  };

  struct WorkResults
  {
    WorkReference            reference;
    std::vector<WorkRow>     rows; // those that finished, without the reference
    std::vector<std::size_t> dominated_by,
      dominated_in_time; // no_point on the front
    bool                     steady = true;
    std::vector<WorkPick>    picks;
    std::vector<TimeRow>     in_time;
    std::string              method_in_time; // the method and the lattice of in_time
    std::vector<std::string> without;        // rows that do not have what is measured
    double                   error_in_space = std::numeric_limits<double>::quiet_NaN(); // of these

    /** Positions of the front by rising cost; @p in_time: wall time in place of work. */
    std::vector<std::size_t> front(const bool in_time) const;

    /** The rows of a family, from coarse to fine. */
    std::vector<std::size_t> of_family(const WorkFamily &family) const;

    /** Work and error of some rows, or wall time and error. */
    std::vector<WorkPoint> points(const std::vector<std::size_t> &some, const bool in_time) const;
    std::vector<WorkPoint> points(const bool in_time) const;
  };

  /** The lattices whose vertices the reference is needed at: all of the rows, each once. */
  std::vector<CellCounts> lattices_of(const WorkPlan &plan);

  /**
   * Read the rows' values and compare them. On rank 0 only. Throws UserError if the reference or
   * the values of a finished row are missing.
   */
  WorkResults evaluate_work(const CrackedBox    &box,
                            const WorkPlan      &plan,
                            const ComputedStudy &computed);
} // namespace PeriDeal
