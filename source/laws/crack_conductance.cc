// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/exceptions.h>

#include <perideal/laws/crack_conductance.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace PeriDeal
{
  double contact_fraction(const double contact_conductance,
                          const double normal_extent,
                          const double conductivity)
  {
    Assert(contact_conductance >= 0., dealii::ExcMessage("A contact conductance is not negative."));
    if (std::isinf(contact_conductance))
      return 1.;
    const double across = contact_conductance * std::abs(normal_extent);
    return across > 0. ? across / (across + conductivity) : 0.;
  }


  namespace
  {
    double measured_factor(const double horizon_ratio)
    {
      return 1.9 + 0.5 * std::min(1., std::max(0., horizon_ratio - 2.));
    }
  } // namespace


  double contact_conductance_of_transmission(const double transmission,
                                             const double conductivity,
                                             const double delta,
                                             const double horizon_ratio)
  {
    if (transmission >= 1.)
      return std::numeric_limits<double>::infinity();
    return measured_factor(horizon_ratio) * conductivity * transmission /
           ((1. - transmission) * delta);
  }


  double transmission_of_contact_conductance(const double contact_conductance,
                                             const double conductivity,
                                             const double delta,
                                             const double horizon_ratio)
  {
    if (std::isinf(contact_conductance))
      return 1.;
    const double scaled = contact_conductance * delta;
    return scaled / (scaled + measured_factor(horizon_ratio) * conductivity);
  }
} // namespace PeriDeal
