// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "finite_results.h"

#include <perideal/solvers/step_tools.h>

#include <cmath>
#include <sstream>

namespace PeriDeal
{
  void require_finite(const std::vector<std::pair<std::string, double>> &values,
                      const std::string                                 &model,
                      const double                                       t,
                      const std::string                                 &remedy)
  {
    for (const auto &[name, value] : values)
      {
        if (std::isfinite(value))
          continue;
        std::ostringstream message;
        message << "The run ends since a result of model '" << model << "' is not finite: the "
                << name << " at t = " << t << " is " << value << ". " << remedy;
        throw not_finite(message.str(), t); // which summary.json has as a guard
      }
  }
} // namespace PeriDeal
