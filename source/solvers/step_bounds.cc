// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/exceptions.h>

#include <perideal/solvers/step_bounds.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "rkc_coefficients.h"

namespace PeriDeal
{
  namespace
  {
    /** T_s(x) of any x. */
    double chebyshev_polynomial(const unsigned int s, const double x)
    {
      if (std::abs(x) <= 1.)
        return std::cos(s * std::acos(x));
      const double size = std::cosh(s * std::acosh(std::abs(x)));
      return x < 0. && s % 2 == 1 ? -size : size;
    }


    /** Where |a + b T_s(w0 - w1 z)| = 1 beyond the interval in which T_s oscillates. */
    double rkc2_limit(const unsigned int s)
    {
      const RkcCoefficients k(s);
      if (s % 2 == 0) // T_s is even: it comes back to its value at z = 0, where all is left
        return 2. * k.w0 / k.w1;
      const double size = (1. + k.a[s]) / k.b[s];
      return (k.w0 + std::cosh(std::acosh(size) / s)) / k.w1;
    }
  } // namespace


  double amplification(const std::string &method, const double z, const unsigned int n_stages)
  {
    if (method == "euler")
      return std::abs(1. - z);
    if (method == "rk4")
      return std::abs(1. - z * (1. - z / 2. * (1. - z / 3. * (1. - z / 4.))));
    if (method == "verlet")
      {
        const double half_trace = 0.5 * z * z - 1.;
        return z <= 2. ? 1. : half_trace + std::sqrt(half_trace * half_trace - 1.);
      }
    Assert(method == "rkc2" && n_stages >= 2, dealii::ExcMessage("No method with this factor."));
    const RkcCoefficients k(n_stages);
    return std::abs(k.a[n_stages] +
                    k.b[n_stages] * chebyshev_polynomial(n_stages, k.w0 - k.w1 * z));
  }


  double stability_limit(const std::string &method, const unsigned int n_stages)
  {
    if (method == "euler" || method == "verlet")
      return 2.;
    if (method == "rk4")
      return 2.785293563405282; // where |1 - z + z^2/2 - z^3/6 + z^4/24| = 1
    if (method == "rkc2" && n_stages >= 2)
      return rkc2_limit(n_stages);
    return std::numeric_limits<double>::infinity();
  }


  unsigned int rkc2_stages(const double z)
  {
    // Beyond the interval in which T_s oscillates nothing is damped: z <= (1 + w0)/w1, which is at
    // least (s^2 - 1)/1.54.
    return std::max(2u, 1u + static_cast<unsigned int>(std::sqrt(1.54 * z + 1.)));
  }
} // namespace PeriDeal
