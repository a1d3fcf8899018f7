// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/laws/gauss_rule.h>
#include <perideal/scene/material.h>

namespace PeriDeal
{
  /**
   * Heat per volume at a temperature: the integral of rho c over the temperature from 0 on, by 8 Gauss points where rho c depends on it.
   */
  template <int dim>
  double heat_content(const Material           &material,
                      const dealii::Point<dim> &p,
                      const double              temperature)
  {
    if (!material.storage_depends_on_temperature())
      return material.storage(p) * temperature;
    static const GaussRule rule(8);
    return rule.integrate(0., temperature, [&](const double T) { return material.storage(p, T); });
  }
} // namespace PeriDeal
