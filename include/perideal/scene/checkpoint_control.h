// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/section.h>

#include <string>
#include <vector>

namespace PeriDeal
{
  /** Section `Checkpoint`: when the state of a run is kept, and how many such states are. */
  class CheckpointControl : public SceneSection
  {
  public:
    CheckpointControl();

    double              every           = 600.; // seconds of wall time; 0: none
    double              wall_time_limit = 0.;   // seconds; 0: none
    std::vector<double> times;                  // simulated, sorted
    unsigned int        n_kept = 2;

    /** Throws UserError. @param end_time the last of `Times` at most; a steady scene has none. */
    void parse(const double end_time, const bool steady);

  private:
    double duration(const std::string &entry) const;
  };


  /**
   * Seconds of a duration with its unit, `90 s`, `1.5 min` or `8 h`, or `0`; negative if the text
   * is none.
   */
  double seconds_of(const std::string &text);
} // namespace PeriDeal
