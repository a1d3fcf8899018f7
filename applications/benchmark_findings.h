// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <cstdio>
#include <string>
#include <vector>

namespace PeriDeal
{
  /** Lines of the table at the end. */
  struct Finding
  {
    std::string what, measured, target;
    int         met; // -1: no target
  };


  inline std::vector<Finding> findings;


  template <typename... Arguments>
  std::string text(const char *format, const Arguments... arguments)
  {
    char buffer[200];
    std::snprintf(buffer, sizeof(buffer), format, arguments...);
    return buffer;
  }


  /** For the table; printed at once, too. @p met -1: no target. */
  inline void found(const std::string &what,
                    const std::string &measured,
                    const std::string &target = "",
                    const int          met    = -1)
  {
    findings.push_back({what, measured, target, met});
    std::printf("%s: %s\n", what.c_str(), measured.c_str());
    std::fflush(stdout);
  }


  /** Building coupled operators, and moving their zones (coupling_benchmarks.cc). */
  void measure_coupling();

  /** Elastic bonds, and one static solution (elastic_benchmarks.cc). */
  void measure_elasticity();

  /** Explicit steps of bodies whose bonds may break (breaking_benchmarks.cc). */
  void measure_breaking();

  /** The same bonds in other programs, if they are installed. */
  void measure_peers();
} // namespace PeriDeal
