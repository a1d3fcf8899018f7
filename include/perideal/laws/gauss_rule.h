// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <vector>

namespace PeriDeal
{
  /** Points and weights of the Gauss-Legendre rule on [0,1]; the weights sum to one. */
  struct GaussRule
  {
    explicit GaussRule(const unsigned int n_points);

    /** Integral of @p f over [a,b]. */
    template <typename Function>
    double integrate(const double a, const double b, const Function &f) const;

    std::vector<double> points, weights;
  };


  template <typename Function>
  double GaussRule::integrate(const double a, const double b, const Function &f) const
  {
    double sum = 0.;
    for (unsigned int q = 0; q < points.size(); ++q)
      sum += weights[q] * f(a + (b - a) * points[q]);
    return sum * (b - a);
  }
} // namespace PeriDeal
