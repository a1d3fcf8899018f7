// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <string>

namespace PeriDeal
{
  /** A word of a command as a shell has to be given it. */
  std::string quoted_for_shell(const std::string &word);

  /**
   * The command that goes on with a run of the program that was stopped: the same with `--resume`,
   * under mpirun if there are several processes; a study goes on by itself. Whoever started the
   * program says in the environment, `PERIDEAL_COMMAND`, what the user has called.
   */
  std::string command_that_resumes(const int          argc,
                                   const char *const *argv,
                                   const unsigned int n_processes);
} // namespace PeriDeal
