// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/exceptions.h>

#include <perideal/laws/kernel.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  double kernel_shape(const KernelShape shape, const double r, const double delta)
  {
    switch (shape)
      {
        case KernelShape::constant:
          return 1.;
        case KernelShape::conical:
          return std::max(0., 1. - r / delta);
        case KernelShape::gaussian:
          return std::exp(-4. * (r / delta) * (r / delta));
      }
    Assert(false, dealii::ExcInternalError());
    return 0.;
  }


  namespace
  {
    /** Integral of shape(s) s^p over s in [0,1], with delta = 1. */
    double radial_moment(const KernelShape shape, const unsigned int p)
    {
      if (shape == KernelShape::constant)
        return 1. / (p + 1.);
      if (shape == KernelShape::conical)
        return 1. / ((p + 1.) * (p + 2.));
      // s^(p-1) times s exp(-4 s^2) by parts.
      if (p == 0)
        return 0.25 * std::sqrt(std::acos(-1.)) * std::erf(2.);
      if (p == 1)
        return -0.125 * std::expm1(-4.);
      return 0.125 * ((p - 1.) * radial_moment(shape, p - 2) - std::exp(-4.));
    }
  } // namespace


  double micro_conductivity(const unsigned int dim,
                            const KernelShape  shape,
                            const unsigned int n,
                            const double       delta,
                            const double       kappa)
  {
    Assert(dim >= 1 && dim <= 3, dealii::ExcMessage("Dimensions are 1, 2 and 3."));
    Assert(n <= 2, dealii::ExcMessage("Kernel exponents are 0, 1 and 2."));
    Assert(delta > 0., dealii::ExcMessage("The horizon must be positive."));
    const double pi      = std::acos(-1.);
    const double angular = dim == 1 ? 2. : (dim == 2 ? pi : 4. * pi / 3.);
    const int    power   = static_cast<int>(dim) + 2 - static_cast<int>(n);
    return 2. * kappa / (angular * std::pow(delta, power) * radial_moment(shape, power - 1));
  }
} // namespace PeriDeal
