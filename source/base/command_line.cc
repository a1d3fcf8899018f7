// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/command_line.h>

#include <cstdlib>

namespace PeriDeal
{
  std::string quoted_for_shell(const std::string &word)
  {
    const char *const plain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=/.,:@%";
    if (!word.empty() && word.find_first_not_of(plain) == std::string::npos)
      return word;
    std::string text;
    for (const char c : word)
      text += c == '\'' ? "'\\''" : std::string(1, c);
    return "'" + text + "'";
  }


  std::string command_that_resumes(const int          argc,
                                   const char *const *argv,
                                   const unsigned int n_processes)
  {
    const std::string end = argc > 1 && std::string(argv[1]) == "study" ? "" : " --resume";
    if (const char *const command = std::getenv("PERIDEAL_COMMAND"))
      return command + end;
    std::string text = n_processes > 1 ? "mpirun -np " + std::to_string(n_processes) : "";
    for (int k = 0; k < argc; ++k)
      if (const std::string word = argv[k]; word != "--resume" && word != "--overwrite")
        text += (text.empty() ? "" : " ") + quoted_for_shell(word);
    return text + end;
  }
} // namespace PeriDeal
