// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/point.h>

#include <sstream>
#include <string>

namespace PeriDeal
{
  /** A place for messages, as `(x, y)`. */
  template <int dim>
  std::string place_text(const dealii::Point<dim> &p)
  {
    std::ostringstream text;
    text << '(';
    for (unsigned int d = 0; d < dim; ++d)
      text << (d > 0 ? ", " : "") << p[d];
    text << ')';
    return text.str();
  }
} // namespace PeriDeal
