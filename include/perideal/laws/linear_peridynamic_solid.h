// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/laws/elasticity.h>

namespace PeriDeal
{
  /**
   * The linear peridynamic solid (Silling et al. 2007; in 2D Le et al. 2014), and without
   * dilatations the bond-based solid, as functions of one node and of one bond. With W = V_i V_j
   * omega f, q = sum_j W x^2/V_i, and the symbols of StateLaw, sums over bonds know
   *
   *   product   W x e, e the extension of the bond, thermal extension taken off
   *   spring    (b_i/q_i + b_j/q_j)/(W x^2)
   *   tau       c theta/q of a node, theta = d sum_j W x e/(V q)
   *
   * and a node outside of the body, whose family stores nothing, has b/q = tau = 0.
   */
  namespace LinearPeridynamicSolid
  {
    /** b/q: what a node makes of the extensions of its bonds. */
    inline double stiffness(const StateLaw &law, const double q)
    {
      return law.extension / q;
    }

    /** tau of a node whose products have this sum. */
    inline double tension(const StateLaw &law,
                          const double    q,
                          const double    volume,
                          const double    sum)
    {
      return law.volumetric * law.dilatation * sum / (q * q * volume);
    }

    /**
     * What of c the shear modulus multiplies while the bulk modulus stays, in 3D and plane strain,
     * where c = d (K - 5/3 G) and b = d (d + 2) G.
     */
    inline double shear_factor(const StateLaw &law)
    {
      return -5. / (3. * (law.dilatation + 2.)) * law.extension;
    }

    /** The same of tau. */
    inline double shear_tension(const StateLaw &law,
                                const double    q,
                                const double    volume,
                                const double    sum)
    {
      return shear_factor(law) * law.dilatation * sum / (q * q * volume);
    }

    /** Of both ends of a bond. @param square W x^2 */
    inline double spring(const double stiffnesses, const double square)
    {
      return stiffnesses / square;
    }

    /** The force along W xi (W x Y/|Y|) by which a bond pulls. @param tau of both ends */
    inline double force(const double spring, const double product, const double tau)
    {
      return spring * product + tau;
    }

    /** What a bond stores by its extension; each end that has a family has a half of it. */
    inline double bond_energy(const double spring, const double product)
    {
      return 0.5 * spring * product * product;
    }

    /** What a node stores by its dilatation. @param sum of products */
    inline double node_energy(const double tau, const double sum)
    {
      return 0.5 * tau * sum;
    }
  } // namespace LinearPeridynamicSolid
} // namespace PeriDeal
