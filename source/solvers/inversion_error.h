// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/diverged.h>
#include <perideal/operators/solid/elastic_operator.h>

#include <sstream>
#include <string>

namespace PeriDeal
{
  /** The error of a body that is inside out at t, with the place of the worst node. */
  inline Diverged inversion_error(const std::string &message,
                                  const Inversion   &found,
                                  const double       t)
  {
    Diverged           error(message, "inversion", found.n_nodes, 0., t);
    std::istringstream place(found.place); // `(x, y)`
    char               mark = 0;
    for (double x = 0.; place >> mark >> x;)
      error.trip.place.push_back(x);
    return error;
  }
} // namespace PeriDeal
