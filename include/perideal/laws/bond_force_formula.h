// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/laws/bond_law.h>
#include <perideal/laws/gauss_rule.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace PeriDeal
{
  /**
   * Bonds whose force is a function F of their stretch s = e/x and of the damage of their ends, in
   * units of the force of the linear solid at s = 1: W x e* = W x^2 F(s), so that F = s is the
   * linear solid to the last bit. The energy is the integral of F, by five Gauss points on each of
   * four parts, the slope a central difference. F(0) = 0.
   */
  class BondForceFormula : public BondLaw
  {
  public:
    /** @param force of stretch and damage, 0 at stretch 0 */
    explicit BondForceFormula(std::function<double(const double, const double)> force)
      : force(std::move(force))
    {}

    bool knows_damage() const override
    {
      return true;
    }

    double effective(const BondValues &bond, const double *) const override
    {
      const double s = bond.stretch();
      return s == 0. ? 0. : bond.product * (force(s, bond.damage) / s);
    }

    double slope(const BondValues &bond, const double *) const override
    {
      const double s = bond.stretch(), step = 1e-6 * std::max(std::abs(s), 1e-3);
      return (force(s + step, bond.damage) - force(s - step, bond.damage)) / (2. * step);
    }

    double energy(const BondValues &bond,
                  const double * /*history*/,
                  const bool dissipated) const override
    {
      if (dissipated)
        return 0.;
      constexpr unsigned int n_parts = 4;
      const double           s       = bond.stretch();
      double                 sum     = 0.;
      for (unsigned int k = 0; k < n_parts; ++k)
        sum += rule.integrate(s * k / n_parts, s * (k + 1) / n_parts, [&](const double at) {
          return force(at, bond.damage);
        });
      return bond.square * bond.square * sum;
    }

  private:
    const std::function<double(const double, const double)> force;
    const GaussRule                                         rule{5};
  };
} // namespace PeriDeal
