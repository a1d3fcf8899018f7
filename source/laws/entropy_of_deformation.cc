// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/laws/entropy_of_deformation.h>

namespace PeriDeal
{
  double entropy_of_deformation(const Moduli      &moduli,
                                const double       expansion,
                                const unsigned int dim,
                                const PlaneState   plane,
                                const double       trace,
                                const double       temperature_change)
  {
    const double nu = moduli.poisson(), beta = moduli.young() / (1. - 2. * nu) * expansion;
    if (dim == 3 || (dim == 2 && plane == PlaneState::strain))
      return beta * trace;
    // Across a plate the strain is (-nu e + (1 + nu) alpha dT)/(1 - nu), across a bar -nu e + (1 +
    // nu) alpha dT in both directions.
    const double n_free = 3. - dim, held = dim == 2 ? 1. - nu : 1.;
    return beta / held *
           ((1. - 2. * nu) * trace + n_free * (1. + nu) * expansion * temperature_change);
  }
} // namespace PeriDeal
