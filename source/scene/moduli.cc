// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/exceptions.h>

#include <perideal/scene/moduli.h>

#include <utility>

namespace PeriDeal
{
  // In terms of G/K, which is 0 and not undefined for an infinite bulk modulus.
  double Moduli::young() const
  {
    return 9. * shear / (3. + shear / bulk);
  }


  double Moduli::poisson() const
  {
    return (3. - 2. * shear / bulk) / (2. * (3. + shear / bulk));
  }


  double Moduli::lambda() const
  {
    return bulk - 2. / 3. * shear;
  }


  namespace
  {
    /** In the order of the enumeration. */
    void sort(Modulus &a, double &value_a, Modulus &b, double &value_b)
    {
      Assert(a != b, dealii::ExcMessage("Two different moduli are needed."));
      if (a > b)
        {
          std::swap(a, b);
          std::swap(value_a, value_b);
        }
    }
  } // namespace


  Moduli moduli_from(Modulus a, double value_a, Modulus b, double value_b)
  {
    sort(a, value_a, b, value_b);
    Moduli moduli;
    if (a == Modulus::bulk)
      {
        const double K = value_a;
        moduli.bulk    = K;
        moduli.shear   = b == Modulus::shear ? value_b :
                         b == Modulus::young ? 3. * K * value_b / (9. * K - value_b) :
                                               1.5 * K * (1. - 2. * value_b) / (1. + value_b);
      }
    else if (a == Modulus::shear)
      {
        const double G = value_a;
        moduli.shear   = G;
        moduli.bulk    = b == Modulus::young ? G * value_b / (3. * (3. * G - value_b)) :
                                               2. / 3. * G * (1. + value_b) / (1. - 2. * value_b);
      }
    else
      {
        moduli.bulk  = value_a / (3. * (1. - 2. * value_b));
        moduli.shear = value_a / (2. * (1. + value_b));
      }
    return moduli;
  }


  double poisson_from(Modulus a, double value_a, Modulus b, double value_b)
  {
    sort(a, value_a, b, value_b);
    if (b == Modulus::poisson)
      return value_b;
    if (a == Modulus::bulk && b == Modulus::shear)
      return Moduli{value_a, value_b}.poisson();
    if (a == Modulus::bulk)
      return 0.5 - value_b / (6. * value_a);
    return value_b / (2. * value_a) - 1.;
  }
} // namespace PeriDeal
