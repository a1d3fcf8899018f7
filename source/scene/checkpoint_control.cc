// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/checkpoint_control.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace PeriDeal
{
  double seconds_of(const std::string &text)
  {
    const double seconds = number_with_unit(text, {{"s", 1.}, {"min", 60.}, {"h", 3600.}});
    return number_with_unit(text, {{"", 1.}}) == 0. ? 0. : seconds;
  }


  CheckpointControl::CheckpointControl()
    : SceneSection("Checkpoint")
  {
    declare(
      "Every",
      EntryType::text,
      "10 min",
      "",
      "Wall time between two checkpoints: a number and its unit, s, min or h. 0: none but those of `Times` and where the run is stopped. "
      "`perideal run SCENE.prm --resume` goes on from the newest; a run that is complete removes its own.");
    declare(
      "Times",
      EntryType::list,
      "",
      "time",
      "Simulated times, separated by commas: a checkpoint is written, too, after the first step that reaches one. Steps do not land on them.");
    declare(
      "Keep",
      EntryType::whole_number,
      "2",
      "1",
      "So many of the newest checkpoints are kept, 1 or more. Each has the size of the vectors of "
      "the run.");
    declare(
      "Wall time limit",
      EntryType::text,
      "",
      "",
      "The run stops with a checkpoint and exit status 3 before it has taken this much wall time, a number and its unit, s, min or h. Empty: no limit. "
      "A run that is resumed has the whole of it again.");
  }


  double CheckpointControl::duration(const std::string &entry) const
  {
    const double seconds = seconds_of(text(entry));
    if (seconds < 0.)
      error(
        entry,
        "found '" + text(entry) +
          "', needs a time of the clock with its unit, s, min or h, such as '90 s', '10 min' or '8 h'" +
          (entry == "Every" ? ", or 0 for none." : "."));
    return seconds;
  }


  void CheckpointControl::parse(const double end_time, const bool steady)
  {
    every           = duration("Every");
    wall_time_limit = text("Wall time limit").empty() ? 0. : duration("Wall time limit");
    if (!text("Wall time limit").empty() && !(wall_time_limit > 0.))
      error("Wall time limit",
            "found '" + text("Wall time limit") + "', needs more than 0, or nothing.");
    n_kept = whole_number("Keep");
    refuse(n_kept == 0, "Keep", "found 0, needs 1 or more.");
    times.clear();
    const std::vector<std::string> pieces = split_list(text("Times"), ',');
    if (steady && !pieces.empty())
      error(
        "Times",
        "is given, but the scene is steady ('Steady' in section 'Time', or an elastic equilibrium): there are no times to reach.");
    for (const std::string &piece : pieces)
      {
        const double time = parse_number(piece, where("Times"));
        if (!(time > 0.) || time > end_time)
          error("Times",
                "the time " + piece +
                  " is not between 0 and 'End time' in section 'Time', which is " +
                  number_text(end_time) + ".");
        times.push_back(time);
      }
    std::sort(times.begin(), times.end());
    times.erase(std::unique(times.begin(), times.end()), times.end());
  }
} // namespace PeriDeal
