// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/section.h>

namespace PeriDeal
{
  /** What a run does when its state is found to be none. */
  enum class GuardAction
  {
    stop,
    warn,
    off // nothing is looked for
  };


  /** Section `Guards`. */
  class GuardControl : public SceneSection
  {
  public:
    GuardControl();

    GuardAction action = GuardAction::stop;

    /** What solvers find wrong, and could go on from, does not end the run. */
    bool goes_on() const
    {
      return action != GuardAction::stop;
    }

    void parse();
  };
} // namespace PeriDeal
