// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

namespace PeriDeal
{
  /**
   * Part of its conductance that a bond or a pair of nodes keeps when a crack of contact
   * conductance H separates it: t = H |xi.n|/(H |xi.n| + kappa), the resistance 1/H of the crack in
   * series with that of the bond's extent across the crack.
   *
   * @param contact_conductance H >= 0, flux over temperature jump; infinite: intact
   * @param normal_extent       |xi.n|, component of the bond along the crack's normal; its sign is
   *                            ignored
   * @param conductivity        kappa > 0 of the bond
   * @return a number in [0,1]; 0 for an insulated crack
   */
  double contact_fraction(const double contact_conductance,
                          const double normal_extent,
                          const double conductivity);

  /**
   * Contact conductance H = C kappa t/((1-t) delta) of a crack whose separated bonds all keep the
   * part t. So a constant transmission is a crack that conducts the better the smaller the horizon
   * is. C was measured: 1.9 at m = 2 and 2.4 at m = 3 (conical kernel, n = 2); linear between,
   * constant outside. Infinite for t = 1.
   *
   * @param transmission  t in [0,1]
   * @param horizon_ratio m = delta / spacing
   */
  double contact_conductance_of_transmission(const double transmission,
                                             const double conductivity,
                                             const double delta,
                                             const double horizon_ratio);

  /** The inverse: t = H delta/(H delta + C kappa). */
  double transmission_of_contact_conductance(const double contact_conductance,
                                             const double conductivity,
                                             const double delta,
                                             const double horizon_ratio);
} // namespace PeriDeal
