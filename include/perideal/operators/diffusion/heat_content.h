// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/laws/gauss_rule.h>
#include <perideal/scene/material.h>

#include <cmath>

namespace PeriDeal
{
  /**
   * Heat per volume from one temperature to another: the integral of rho c, by n Gauss points where
   * rho c depends on the temperature.
   */
  template <int dim, int n = 3>
  double heat_between_temperatures(const Material           &material,
                                   const dealii::Point<dim> &p,
                                   const double              from,
                                   const double              to)
  {
    if (!material.storage_depends_on_temperature())
      return material.storage(p) * (to - from);
    static const GaussRule rule(n);
    return rule.integrate(from, to, [&](const double T) { return material.storage(p, T); });
  }


  /**
   * Heat per volume at a temperature: the integral of rho c over the temperature from 0 on, in
   * pieces until halving them changes nothing.
   */
  template <int dim>
  double heat_content(const Material           &material,
                      const dealii::Point<dim> &p,
                      const double              temperature)
  {
    if (!material.storage_depends_on_temperature())
      return material.storage(p) * temperature;
    constexpr double       exact = 1e-12;
    constexpr unsigned int most  = 64;
    double heat = heat_between_temperatures<dim, 8>(material, p, 0., temperature), size = 0.;
    for (unsigned int pieces = 2; pieces <= most; pieces *= 2)
      {
        const double coarse = heat, step = temperature / pieces;
        heat = size = 0.;
        for (unsigned int k = 0; k < pieces; ++k)
          {
            const double piece =
              heat_between_temperatures<dim, 8>(material, p, k * step, (k + 1) * step);
            heat += piece;
            size += std::abs(piece);
          }
        if (!(std::abs(heat - coarse) > exact * size))
          break;
      }
    return heat;
  }
} // namespace PeriDeal
