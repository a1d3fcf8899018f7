// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/solvers/step_span.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  /** A span of a motion in at most 50 parts of whole steps, with a report after each. */
  struct MotionParts
  {
    StepSpan span;
    double   n_steps = 0.; // planned, of the motion

    /** @param step of the motion, as long as it is now */
    static MotionParts between(const double from, const double to, const double step)
    {
      constexpr double most = 50.;
      MotionParts      parts;
      parts.n_steps      = std::max(1., std::ceil((to - from) / step * (1. - 1e-10)));
      parts.span         = StepSpan::between(from, to);
      parts.span.n_steps = static_cast<unsigned long long>(std::min(parts.n_steps, most));
      return parts;
    }

    /** The end of the part. With whole steps between two ends reports change no step. */
    double next() const
    {
      const unsigned long long part = span.n_done + 1;
      if (part == span.n_steps)
        return span.end;
      return span.start +
             (span.end - span.start) * std::floor(n_steps * part / span.n_steps) / n_steps;
    }

    void exchange(Archive &archive)
    {
      const Archive::Part part(archive, "parts");
      span.exchange(archive);
      archive.exchange("planned steps", n_steps);
    }
  };
} // namespace PeriDeal
