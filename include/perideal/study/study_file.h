// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/study/naming.h>

#include <mpi.h>

#include <optional>
#include <set>
#include <string>
#include <vector>

namespace PeriDeal
{
  /** One scene with overrides, to be computed once. */
  struct StudyRow
  {
    std::string name;
    std::string
      sweep; // the name in the study file, shared by all combinations of a row with "vary"
    std::string           scene; // path as found from the working directory
    std::string           group;
    std::vector<Setting>  settings; // overrides of all rows and of this one, each entry once
    std::optional<double> x;        // a number for figures,
    std::string           x_entry;  // or the entry whose value it is
    bool                  quick    = false;
    bool                  fails    = false; // has to end with a UserError
    bool                  may_fail = false; // may end with one
  };


  /** A figure that applications/report/study.py draws from the results. */
  struct StudyFigure
  {
    std::string name, title, x, y;
    std::vector<std::string>
         lines; // columns that distinguish lines; empty: model and all else that varies
    bool log = false;
  };


  /** A list of runs, and what is to be drawn from them. */
  struct Study
  {
    std::string              source; // the study file, or "command line": messages begin with it
    std::string              title, text, output;
    std::vector<StudyRow>    rows;
    std::vector<StudyFigure> figures;
    // Entries of scenes with a column of their own: those that rows set or vary, or figures name.
    std::vector<std::string> columns;
    std::set<std::string>    varied; // those of them that rows vary
  };


  /**
   * Read a study file (JSON with comments), find its scenes relative to the working directory, the
   * folder of the study file, or the parents of that. Whether entries exist is checked, whether
   * scenes are valid is not. Throws UserError for all mistakes, with file, row and key; collective.
   *
   * Programs that plan a study say besides what messages call it ("source"), which entries are
   * columns and which of them vary ("columns", "varied"; else those that rows set and vary), and
   * what rows have in common ("row", else their name).
   */
  Study read_study(const std::string &file_name, const MPI_Comm communicator);

  /** All combinations of @p variations of each scene. Throws UserError; collective. */
  Study sweep_of_scenes(const std::vector<std::string> &scenes,
                        const std::vector<Variation>   &variations,
                        const MPI_Comm                  communicator);

  /**
   * Apply "Section/Entry=value" to all rows, stronger than what they say themselves. Throws
   * UserError.
   */
  void override_rows(Study &study, const std::vector<std::string> &overrides);

  /**
   * The columns of numbers and texts that every study has, in the order of study.csv; entries of
   * scenes come after the group.
   */
  const std::vector<std::string> &study_columns();
} // namespace PeriDeal
