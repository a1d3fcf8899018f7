// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/diverged.h>
#include <perideal/base/place_text.h>
#include <perideal/scene/lists.h>

#include <cmath>
#include <string>

namespace PeriDeal
{
  /**
   * What to say of a conductivity or a storage that has become zero or less, or no number, at a
   * temperature that the run has reached, or at any if that is no number. @param entry its names,
   * with quotes
   */
  template <int dim>
  Trip not_positive(const std::string        &entry,
                    const double              value,
                    const double              temperature,
                    const dealii::Point<dim> &p)
  {
    Trip trip;
    trip.monitor = "formulas";
    trip.value   = value;
    trip.bound   = 0.;
    trip.place   = {p.begin_raw(), p.end_raw()};
    trip.found =
      entry + " in section 'Material' is " + rounded_text(value, 6) + " at " + place_text(p) +
      (std::isfinite(temperature) ?
         ", T = " + rounded_text(temperature, 6) +
           "; it must be positive at every temperature that the run reaches." :
         "; it must be positive everywhere in the body, at every temperature that the run reaches.");
    return trip;
  }
} // namespace PeriDeal
