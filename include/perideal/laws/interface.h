// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/choices.h>

#include <functional>

namespace PeriDeal
{
  /**
   * No bond of an exchange is active across a jump of the conductivity (the stiffness) by more than
   * this factor: so layers stay exact.
   */
  constexpr double largest_contrast = 1.5;


  /**
   * Conductivity of a bond between two nodes of conductivity a and b (not negative): the smaller
   * (Bobaru 2012, example 6), the mean (Tan 2020), or the harmonic mean 2ab/(a+b), which is
   * Diyaroglu 2017, eq 12, with the interface half way. Symmetric.
   */
  double interface_conductivity(const InterfaceRule rule, const double a, const double b);

  /**
   * Harmonic conductivity of a bond through a varying material (Diyaroglu 2017, eq 12, for any
   * number of phases): one over the integral of 1/kappa(s) over the bond, s in [0,1] from end to
   * end.
   *
   * Between two constant phases the crossing is bisected to 1e-12 of the bond; elsewhere the
   * integral is adaptive Gauss quadrature, to about 1e-12. The first look is at 32 places along the
   * bond: phases thinner than 1/20 of it can be missed. Zero where kappa is zero.
   */
  double harmonic_conductivity(const std::function<double(const double)> &kappa);
} // namespace PeriDeal
