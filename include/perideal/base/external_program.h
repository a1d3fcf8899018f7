// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <filesystem>
#include <string>

namespace PeriDeal
{
  /** A word of a command of the shell. */
  std::string shell_word(const std::string &text);

  /** A folder for temporary files that is there while this lives. Not collective. */
  class TemporaryFolder
  {
  public:
    /** @param name that its own begins with */
    explicit TemporaryFolder(const std::string &name);
    ~TemporaryFolder();

    TemporaryFolder(const TemporaryFolder &) = delete;

    std::filesystem::path path; // empty: there can be none
  };

  /** The folder with the Python package perideal that belongs to this program, or nothing. Not
   * collective. */
  std::string python_folder();

  /** The Python for it: $PERIDEAL_PYTHON, else Debian's, else the first in PATH. */
  std::string python_program();
} // namespace PeriDeal
