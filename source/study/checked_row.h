// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/user_error.h>
#include <perideal/problems/problem_factory.h>
#include <perideal/study/study_file.h>

#include <map>
#include <string>

namespace PeriDeal
{
  /** A row whose scene has been read and parsed once, and what is needed to compute it. */
  struct CheckedRow
  {
    StudyRow    row;
    std::string folder; // of its results
    SceneText   text;   // with all overrides and the folder as output directory
    std::string
      mistake;        // of the scene, where the row is one that fails; then what follows is empty
    std::string hash; // of all that determines the results, not of the folder
    std::map<std::string, std::string>
      entries; // every entry of the scene and its text, defaults included
  };

  /** All bytes of a file; empty if it cannot be read. */
  std::string content_of(const std::string &file_name);

  /**
   * What is wrong with the entries of a row: the message without the words for overrides, which
   * stand on no command line there.
   */
  std::string mistake_in_overrides(const UserError &error);

  /**
   * Read and parse the scene of a row. Throws UserError with the study, the row and the scene's own
   * message, unless the row is one that fails. Collective.
   */
  CheckedRow check_row(const Study       &study,
                       const StudyRow    &row,
                       const std::string &folder,
                       const MPI_Comm     communicator);

  /**
   * Call action(scene) with the Scene<dim> that the text describes, which can be computed, the only
   * scene alive then.
   * Throws UserError.
   */
  template <typename Action>
  void with_scene(const SceneText &text, const Action &action);


  template <typename Action>
  void with_scene(const SceneText &text, const Action &action)
  {
    const auto parse = [&](auto &&scene) {
      parse_computable(text, scene);
      action(scene);
    };
    switch (dimension_of(text))
      {
        case 1:
          return parse(Scene<1>());
        case 2:
          return parse(Scene<2>());
        default:
          return parse(Scene<3>());
      }
  }
} // namespace PeriDeal
