// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/laws/gauss_rule.h>
#include <perideal/scene/material.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  /**
   * The integral of a function that may jump, as rho c does at both ends of a latent heat: by three
   * Gauss points on pieces that are halved until that changes less than a part of it.
   */
  template <typename Function>
  double integral_over_jumps(const Function    &f,
                             const double       from,
                             const double       to,
                             const double       part,
                             const unsigned int depth)
  {
    static const GaussRule rule(3);
    const double           middle = 0.5 * (from + to), whole = rule.integrate(from, to, f),
                 first = rule.integrate(from, middle, f), second = rule.integrate(middle, to, f);
    if (depth == 0 ||
        std::abs(first + second - whole) <= part * (std::abs(first) + std::abs(second)))
      return first + second;
    return integral_over_jumps(f, from, middle, part, depth - 1) +
           integral_over_jumps(f, middle, to, part, depth - 1);
  }


  /**
   * Heat per volume from one temperature to another, the integral of rho c. Peaks of rho c that are
   * wider than a sixteenth of the way are seen, and integrated to 1e-10 of the whole.
   */
  template <int dim>
  double heat_between_temperatures(const Material           &material,
                                   const dealii::Point<dim> &p,
                                   const double              from,
                                   const double              to)
  {
    if (!material.storage_depends_on_temperature())
      return material.storage(p) * (to - from);
    constexpr unsigned int n_looks = 16, most_halvings = 40;
    constexpr double       part = 1e-10, smooth = 1.5;
    const auto             storage = [&](const double T) { return material.storage(p, T); };
    double                 lowest = storage(from), highest = lowest;
    for (unsigned int k = 1; k <= n_looks; ++k)
      {
        const double value = storage(from + k * (to - from) / n_looks);
        lowest             = std::min(lowest, value);
        highest            = std::max(highest, value);
      }
    if (highest <= smooth * lowest)
      return integral_over_jumps(storage, from, to, part, most_halvings);
    double heat = 0.;
    for (unsigned int k = 0; k < n_looks; ++k)
      heat += integral_over_jumps(storage,
                                  from + k * (to - from) / n_looks,
                                  from + (k + 1) * (to - from) / n_looks,
                                  part,
                                  most_halvings);
    return heat;
  }


  /** Heat per volume at a temperature: the integral of rho c over the temperature from 0 on. */
  template <int dim>
  double heat_content(const Material           &material,
                      const dealii::Point<dim> &p,
                      const double              temperature)
  {
    return heat_between_temperatures(material, p, 0., temperature);
  }
} // namespace PeriDeal
