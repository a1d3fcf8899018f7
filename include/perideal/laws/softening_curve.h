// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/choices.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace PeriDeal
{
  /**
   * What a bond that softens bears, T(z), over what it bears where it begins to, by its extension z
   * since then in units of that at which all of the area under the curve is 1:
   *
   *   linear      1 - z/2
   *   bilinear    (0, 1), (0.8, 1/3), (3.6, 0): concrete (Petersson 1981)
   *   exponential exp(-z)
   *
   * Not collective.
   */
  class SofteningCurve
  {
  public:
    explicit SofteningCurve(const Softening kind)
      : kind(kind)
    {}

    static constexpr double longest = 9.3; // any z beyond which T is 0

    /** Of z >= 0; below a ten thousandth it is nothing. */
    double operator()(const double z) const
    {
      constexpr double least = 1e-4;
      const double     value = kind == Softening::exponential ? std::exp(-z) :
                               kind == Softening::linear      ? 1. - 0.5 * z :
                               z < kink[0]                    ? 1. - (1. - kink[1]) * z / kink[0] :
                                                                kink[1] * (end - z) / (end - kink[0]);
      return value < least ? 0. : value;
    }

  private:
    static constexpr std::array<double, 2> kink{{0.8, 1. / 3.}};
    static constexpr double                end = 3.6;

    Softening kind;
  };
} // namespace PeriDeal
