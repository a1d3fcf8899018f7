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
      "place and the cause, exit status 1 and the status `diverged`; `warn` says so in a note, once for each kind, and goes on, also where a solver finds energy "
      "from nowhere, a step above its limit or a body inside out; `off` goes on, too, and says nothing. "
      "Values that are not finite, a `Time step` above its limit from the start and what solvers cannot compute are errors in any case.",
      {"stop", "warn", "off"});
  }


  void GuardControl::parse()
  {
    action = choice<GuardAction>("Action");
  }
} // namespace PeriDeal
