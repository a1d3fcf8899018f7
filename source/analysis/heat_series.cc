// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/analysis/heat_series.h>

#include <cmath>

namespace PeriDeal
{
  namespace HeatSeries
  {
    namespace
    {
      const double pi = std::acos(-1.);
      const double first_time =
        1e-11; // below: the initial value; here a series has some 300,000 terms


      /**
       * Sum over n = 1, 3, 5, ... of coefficient(n) mode(n w x) exp(-(n w)^2 t), mode sine or
       * cosine. The coefficients must not grow. In n the terms fall faster than exp(-(n w)^2 t), n
       * w for the slope included, once that is below 1e-18.
       */
      template <typename Coefficient>
      ValueAndSlope sum_odd(const double       x,
                            const double       t,
                            const double       w,
                            const bool         sine,
                            const Coefficient &coefficient)
      {
        const double  period = 2. * pi / w;
        ValueAndSlope sum{0., 0.};
        for (double n = 1.;; n += 2.)
          {
            const double k = n * w, decay = std::exp(-k * k * t);
            // Relative to the slowest mode, which itself is small at late times.
            if (k * std::exp(-(k * k - w * w) * t) < 1e-17 * w)
              break;
            // Whole periods taken off first: exact at the ends, where the prescribed value must
            // come out.
            const double phase = w * std::remainder(n * x, period);
            const double c = coefficient(n) * decay, s = std::sin(phase), z = std::cos(phase);
            sum.value += c * (sine ? s : z);
            sum.slope += c * k * (sine ? z : -s);
          }
        return sum;
      }


      bool on_end(const double x, const double end)
      {
        return std::abs(x - end) < 1e-12;
      }
    } // namespace


    ValueAndSlope cooling_slab(const double x, const double t)
    {
      if (t < first_time)
        return {on_end(x, 0.) || on_end(x, 1.) ? 0. : 1., 0.};
      return sum_odd(x, t, pi, true, [](const double n) { return 4. / (n * pi); });
    }


    ValueAndSlope two_part_bar(const double x,
                               const double t,
                               const double first,
                               const double second,
                               const double right)
    {
      if (t < first_time)
        {
          if (on_end(x, 1.))
            return {right, 0.};
          // At the jump the mean, to which the series goes.
          return {on_end(x, 0.5) ? 0.5 * (first + second) : (x < 0.5 ? first : second), 0.};
        }
      const ValueAndSlope sum = sum_odd(x, t, 0.5 * pi, false, [&](const double n) {
        const double quarter = std::sin(0.25 * n * pi), half = std::sin(0.5 * n * pi);
        return 4. / (n * pi) * ((first - right) * quarter + (second - right) * (half - quarter));
      });
      return {right + sum.value, sum.slope};
    }


    ValueAndSlope heated_bar(const double x, const double t, const double left, const double slope)
    {
      if (t < first_time)
        return {on_end(x, 0.) ? left : 0., 0.};
      const ValueAndSlope sum = sum_odd(x, t, 0.5 * pi, true, [&](const double n) {
        const double k = 0.5 * n * pi;
        return -2. * (left / k + slope * std::sin(k) / (k * k));
      });
      return {left + slope * x + sum.value, slope + sum.slope};
    }
  } // namespace HeatSeries
} // namespace PeriDeal
