// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/external_program.h>

#include <unistd.h>

#include <cstdlib>

namespace PeriDeal
{
  namespace fs = std::filesystem;

  std::string shell_word(const std::string &text)
  {
    std::string word = "'";
    for (const char c : text)
      word += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return word + "'";
  }


  TemporaryFolder::TemporaryFolder(const std::string &name)
  {
    std::error_code ignored;
    std::string     full = (fs::temp_directory_path(ignored) / (name + "_XXXXXX")).string();
    if (mkdtemp(full.data()) != nullptr)
      path = full;
  }


  TemporaryFolder::~TemporaryFolder()
  {
    std::error_code ignored;
    if (!path.empty())
      fs::remove_all(path, ignored);
  }


  std::string python_folder()
  {
    std::error_code error;
    const fs::path  program = fs::read_symlink("/proc/self/exe", error);
    // beside an installed program, and in the folder of the sources
    for (const char *const place : {"../share/perideal/python", "../../../python"})
      {
        const fs::path folder = (program.parent_path() / place).lexically_normal();
        if (!error && fs::exists(folder / "perideal" / "__main__.py", error))
          return folder.string();
      }
    return "";
  }


  std::string python_program()
  {
    if (const char *const chosen = std::getenv("PERIDEAL_PYTHON");
        chosen != nullptr && *chosen != 0)
      return chosen;
    std::error_code error;
    return fs::exists("/usr/bin/python3", error) ? "/usr/bin/python3" : "python3";
  }
} // namespace PeriDeal
