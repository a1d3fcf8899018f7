// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/formula_names.h>
#include <perideal/scene/material.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace PeriDeal
{
  /**
   * The integral of a function that may jump, as rho c does at both ends of a latent heat: by
   * Lobatto's rule of four points on pieces that are halved until that changes less than a part of
   * it.
   */
  template <typename Function>
  double integral_over_jumps(const Function    &f,
                             const double       from,
                             const double       to,
                             const double       part,
                             const unsigned int depth)
  {
    const auto rule = [&](const double a, const double b) {
      const double middle = 0.5 * (a + b), inner = 0.5 * (b - a) / std::sqrt(5.);
      return (b - a) / 12. * (f(a) + f(b) + 5. * (f(middle - inner) + f(middle + inner)));
    };
    const double middle = 0.5 * (from + to), whole = rule(from, to), first = rule(from, middle),
                 second = rule(middle, to);
    // Where f is no number, so is its integral.
    if (depth == 0 ||
        !(std::abs(first + second - whole) > part * (std::abs(first) + std::abs(second))))
      return first + second;
    return integral_over_jumps(f, from, middle, part, depth - 1) +
           integral_over_jumps(f, middle, to, part, depth - 1);
  }


  /**
   * Heat per volume from one temperature to another, the integral of rho c, to 1e-10 of the whole.
   * However narrow, peaks of rho c are seen at or beside Expression::marked_temperatures(), and
   * elsewhere if they are wider than a sixteenth of the way.
   */
  template <int dim>
  double heat_between_temperatures(const Material           &material,
                                   const dealii::Point<dim> &p,
                                   const double              from,
                                   const double              to)
  {
    if (!material.storage_depends_on_temperature())
      return material.storage(p) * (to - from);
    const double way = to - from;
    if (way == 0. || !std::isfinite(way))
      return way;
    constexpr unsigned int n_looks = 16, most_halvings = 40;
    constexpr double       part = 1e-10, smooth = 1.5, beside = 1e-10;
    const auto             storage = [&](const double T) { return material.storage(p, T); };
    const auto [low, high]         = std::minmax(from, to);
    std::vector<double> ends; // of pieces
    for (unsigned int k = 0; k <= n_looks; ++k)
      ends.push_back(low + k * (high - low) / n_looks);
    for (const MaterialProperty *property : {&material.density, &material.heat_capacity})
      {
        const std::vector<double> &marks = property->marked_temperatures(p);
        ends.insert(ends.end(),
                    std::upper_bound(marks.begin(), marks.end(), low),
                    std::lower_bound(marks.begin(), marks.end(), high));
      }
    std::sort(ends.begin(), ends.end());
    std::vector<double> seen(ends.size());
    std::transform(ends.begin(), ends.end(), seen.begin(), storage);
    const auto [least, most] = std::minmax_element(seen.begin(), seen.end());
    if (*most <= smooth * *least)
      ends = {low, high};
    double heat = 0.;
    for (std::size_t k = 1; k < ends.size(); ++k)
      {
        // Not at the ends, where rho c may have the value of the other side.
        const double by = beside * (ends[k] - ends[k - 1]);
        heat += integral_over_jumps(storage, ends[k - 1] + by, ends[k] - by, part, most_halvings) /
                (1. - 2. * beside);
      }
    return from < to ? heat : -heat;
  }


  /**
   * Heat per volume at a temperature: the integral of rho c over the temperature from 0 on, where
   * tables may have no numbers, and these do not matter.
   */
  template <int dim>
  double heat_content(const Material           &material,
                      const dealii::Point<dim> &p,
                      const double              temperature)
  {
    const HeldTableEnds held;
    return heat_between_temperatures(material, p, 0., temperature);
  }
} // namespace PeriDeal
