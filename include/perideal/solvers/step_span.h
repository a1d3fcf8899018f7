// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/archive.h>

#include <functional>

namespace PeriDeal
{
  /**
   * Called after a step that ends at time t and is not the last of its span, when all that the next
   * steps depend on can be kept. What it throws ends the span. Collective.
   */
  using AfterStep = std::function<void(const double t)>;


  /** The times between which a stepper steps, and how far it is. */
  struct StepSpan
  {
    double             start = 0., end = 0., now = 0.;
    unsigned long long n_steps = 0; // all of equal length; 0: as many as it takes
    unsigned long long n_done  = 0; // rejected ones too
    bool               is_open = false;

    /** From t to t_end, no step taken. */
    static StepSpan between(const double t, const double t_end)
    {
      StepSpan span;
      span.start   = t;
      span.end     = t_end;
      span.now     = t;
      span.is_open = true;
      return span;
    }

    void exchange(Archive &archive)
    {
      archive.exchange("span start", start);
      archive.exchange("span end", end);
      archive.exchange("span now", now);
      archive.exchange("span steps", n_steps);
      archive.exchange("span steps done", n_done);
      archive.exchange("span is open", is_open);
    }
  };
} // namespace PeriDeal
