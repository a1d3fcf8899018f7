// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <vector>

namespace PeriDeal
{
  /**
   * Coefficients of the s-stage scheme of Sommeijer, Shampine and Verwer (J. Comput. Appl. Math.
   * 88, 1998). A step leaves a[s] + b[s] T_s(w0 - w1 z) of a field that decays at the rate z/step,
   * T_s the Chebyshev polynomial of degree s.
   */
  struct RkcCoefficients
  {
    explicit RkcCoefficients(const unsigned int s)
      : a(s + 1)
      , b(s + 1)
      , c(s + 1)
    {
      constexpr double    damping = 2. / 13.;
      std::vector<double> T(s + 1), dT(s + 1), ddT(s + 1);
      w0    = 1. + damping / (static_cast<double>(s) * s);
      T[0]  = 1.;
      T[1]  = w0;
      dT[1] = 1.;
      for (unsigned int j = 2; j <= s; ++j)
        {
          T[j]   = 2. * w0 * T[j - 1] - T[j - 2];
          dT[j]  = 2. * T[j - 1] + 2. * w0 * dT[j - 1] - dT[j - 2];
          ddT[j] = 4. * dT[j - 1] + 2. * w0 * ddT[j - 1] - ddT[j - 2];
        }
      w1 = dT[s] / ddT[s];
      for (unsigned int j = 2; j <= s; ++j)
        {
          b[j] = ddT[j] / (dT[j] * dT[j]);
          c[j] = w1 * ddT[j] / dT[j];
        }
      b[0] = b[1] = b[2];
      c[0]        = 0.;
      c[1]        = c[2] / dT[2];
      for (unsigned int j = 0; j <= s; ++j)
        a[j] = 1. - b[j] * T[j];
    }

    double              w0, w1;
    std::vector<double> a, b, c;
  };
} // namespace PeriDeal
