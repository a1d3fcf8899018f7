// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/place_text.h>

namespace PeriDeal
{
  /**
   * The fault of a material whose critical stretch, given or from its fracture energy, is not above
   * 0 at a place.
   */
  template <int dim>
  std::string stretch_fault(const bool is_given, const dealii::Point<dim> &p)
  {
    return std::string("'") + (is_given ? "Critical stretch" : "Fracture energy") +
           "' in section 'Material' is not positive at " + place_text(p) + ".";
  }
} // namespace PeriDeal
