// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/laws/elasticity.h>

namespace PeriDeal
{
  /**
   * What the entropy of a unit of volume grows by when the body deforms: beta tr(eps) with beta = 3
   * K alpha and the trace of the strain in three dimensions, which is that in the plane, e, in
   * plane strain. Where nothing holds the body out of its plane, or across a bar, it contracts and
   * expands there,
   *
   *     plane stress  E alpha/(1 - nu) e + (1 + nu)/((1 - nu) (1 - 2 nu)) E alpha^2 dT,
   *     bar           E alpha e + 2 (1 + nu)/(1 - 2 nu) E alpha^2 dT.
   *
   * In all cases that is alpha tr(sigma) + 9 K alpha^2 dT; infinite at nu = 1/2.
   *
   * @param expansion alpha
   * @param trace     e, of the strain in dim dimensions
   */
  double entropy_of_deformation(const Moduli      &moduli,
                                const double       expansion,
                                const unsigned int dim,
                                const PlaneState   plane,
                                const double       trace,
                                const double       temperature_change);
} // namespace PeriDeal
