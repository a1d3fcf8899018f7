// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <string>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /** One `set` statement of a scene file. */
  struct SceneLine
  {
    std::string  section; // "" outside all sections; "A/B" for B within A
    std::string  entry, value;
    unsigned int line              = 0; // where it begins, from 1
    unsigned int n_lines           = 1; // more with continuation lines
    bool         from_command_line = false;
  };


  /** The statements of a scene file, not yet compared with what is declared. */
  struct SceneLines
  {
    std::vector<SceneLine>                            entries;
    std::vector<std::pair<std::string, unsigned int>> sections; // each `subsection` and its line
  };


  /** "scene.prm:12", or "command line" for overrides. */
  std::string location(const std::string &file_name, const SceneLine &line);

  /**
   * Split the text of a scene into its statements: `set`, `subsection`, `end`, comments after #, a
   * backslash at the end of a line joins it with the next, all as deal.II's ParameterHandler does.
   * Throws UserError with file and line: other statements, `include`, missing or extra `end`.
   */
  SceneLines scan_lines(const std::string &text, const std::string &file_name);

  /** `Section/Entry` and value of each statement, in their order. */
  using SceneEntries = std::vector<std::pair<std::string, std::string>>;

  /** Of a text as scene_with_defaults() gives it: all entries of a scene. */
  SceneEntries entries_of(const std::string &text);

  /**
   * Put overrides "Section/Entry=value" into the text of a scene: in the place of the entry, so
   * that line numbers stay, or at the end. Whether the names exist is not checked here. Throws
   * UserError for an override that has no such form.
   */
  std::string apply_overrides(const std::string              &text,
                              const std::string              &file_name,
                              const std::vector<std::string> &overrides);
} // namespace PeriDeal
