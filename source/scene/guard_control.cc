// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/guard_control.h>

namespace PeriDeal
{
  GuardControl::GuardControl()
    : SceneSection("Guards")
  {
    declare(
      "Action",
      EntryType::choice,
      "stop",
      "",
      "What a run does when its state becomes none (values that are not finite or grow without a cause, parts that have flown off): `stop` ends it there with the "
      "place and the cause, exit status 1 and the status `diverged`; `warn` says so in a note, once for each kind, and goes on; `off` looks for nothing. "
      "What solvers cannot compute is an error in any case.",
      {"stop", "warn", "off"});
  }


  void GuardControl::parse()
  {
    action = choice<GuardAction>("Action");
  }
} // namespace PeriDeal
