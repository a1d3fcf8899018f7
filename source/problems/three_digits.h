// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <sstream>
#include <string>

namespace PeriDeal
{
  /** A number for a sentence, with three digits. */
  inline std::string three_digits(const double x)
  {
    std::ostringstream text;
    text.precision(3);
    text << x;
    return text.str();
  }
} // namespace PeriDeal
