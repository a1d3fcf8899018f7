// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/study/study.h>

#include <set>
#include <string>
#include <vector>

namespace CLI
{
  class App;
}

namespace PeriDeal
{
  /** What the command line asks of `perideal study`. */
  struct StudyRequest
  {
    std::vector<std::string> files; // one study file, or scenes, or a kind of study and its scene
    std::vector<std::string> variations, overrides;
    std::string              output;
    bool                     quiet = false;
    std::set<std::string>    of_drivers; // whose own options were given
    StudyOptions             study;
  };

  /** Add the command and its options, which fill the request. */
  void describe_study(CLI::App &app, StudyRequest &request);

  /** Of these options, for "did you mean". */
  std::vector<std::string> names_of_study_options();

  /** Do what is asked. Throws UserError. Collective. */
  void compute_study(const StudyRequest &request);
} // namespace PeriDeal
