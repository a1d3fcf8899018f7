// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/laws/gauss_rule.h>

#include <cmath>

namespace PeriDeal
{
  GaussRule::GaussRule(const unsigned int n_points)
    : points(n_points)
    , weights(n_points)
  {
    const double pi = std::acos(-1.);
    for (unsigned int i = 0; i < n_points; ++i)
      {
        // Newton on the Legendre polynomial, from the usual first guess.
        double x = std::cos(pi * (i + 0.75) / (n_points + 0.5)), slope = 1.;
        for (unsigned int iteration = 0; iteration < 100; ++iteration)
          {
            double value = x, before = 1.;
            for (unsigned int k = 2; k <= n_points; ++k)
              {
                const double next = ((2. * k - 1.) * x * value - (k - 1.) * before) / k;
                before            = value;
                value             = next;
              }
            slope             = n_points * (x * value - before) / (x * x - 1.);
            const double step = value / slope;
            x -= step;
            if (std::abs(step) < 1e-15)
              break;
          }
        points[n_points - 1 - i]  = 0.5 * (1. + x);
        weights[n_points - 1 - i] = 1. / ((1. - x * x) * slope * slope);
      }
  }
} // namespace PeriDeal
