// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/process_end.h>

#include <functional>
#include <string>
#include <vector>

namespace PeriDeal
{
  /** How a command has ended, and what is to be said of it; nothing where it is complete. */
  struct Ending
  {
    ExitStatus  status = ExitStatus::complete;
    std::string message;
  };

  /**
   * Execute commands one after the other, so that many pay for one start: a line of standard input
   * is a request, an object of JSON with
   *
   * - "arguments": the words behind `perideal`, a list of texts: ["run", "scene.prm", "-s", "..."],
   * - "directory": the working directory of the command; without it the present one,
   * - "output", "errors": files at whose end the command's standard output and error are written;
   *   without them both are the standard error of the server.
   *
   * Each is answered by one line of standard output, {"status": 0, "message": ""}, with the exit
   * status and the error message that the command has as a program of its own. A line that is no
   * request is answered with status 1. The server ends after the last request, and where a signal
   * has stopped a run or comes when none is computed.
   *
   * @param perform executes the words of a command and says what it has to say. Collective.
   */
  ExitStatus serve(const std::function<Ending(const std::vector<std::string> &)> &perform);
} // namespace PeriDeal
