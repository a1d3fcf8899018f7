// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/types.h>
#include <perideal/bonds/families.h>

#include <vector>

namespace PeriDeal
{
  /** The bonds of the linear peridynamic solid as StateOperator stores them, each at both ends. */
  struct StoredBonds
  {
    const std::vector<std::size_t>  &starts; // of each owned node
    const std::vector<unsigned int> &neighbors;
    const std::vector<double>       &weights; // W x^2
  };


  /**
   * `Surface correction` of the linear peridynamic solid: bonds count a W in the dilatations and s
   * W in the extensions, with factors a and s that are the same at both ends of a bond, so that
   * forces stay opposite and energies quadratic forms:
   *
   *   theta_i = d sum_j a W x e/(V_i q_i),
   *   energy of i = 1/2 c/d theta_i^2 V_i + 1/2 b/q_i sum_j s W e^2
   *
   * energy    a, s by ellipsoids from theta and from the energy of extensions under unit stretches
   *           along the axes, against those of a complete family; q of a complete one
   *           (laws/stretch_energy.h)
   * moments   a = s = 1 + (c_i + c_j) . m with m of laws/family_moments.h and c such that all
   *           fourth moments of a node's bonds are those of a complete family: the smallest change,
   *           in the mean of W x^2 over all bonds, that does so. theta, energy and collapsed stress
   *           of a uniform strain then are those inside. In convex corners no positive factors do
   *           so, since sum W xi_x xi_y has one sign there: nodes to whom these c owe a negative
   *           factor have c = 0 and q of their own family.
   */
  struct SurfaceFactors
  {
    std::vector<double> dilatation, extension; // a, s of the stored bonds
    Vector              q;                     // with ghosts, up to date
    unsigned long long  n_left = 0; // nodes that `moments` leaves as they are, of all processes
    // Of the others: largest error of their moments over a complete family's, where the iteration
    // has not found them.
    double gap = 0.;

    /**
     * sum a^2/s W x^2/(V_i q_i) of the owned nodes. (sum a W x e)^2 is at most sum a^2/s W x^2
     * times sum s W e^2: the energy of a node is positive if and only if b + c d times this is.
     */
    std::vector<double> ratio;
  };

  /** Throws UserError for bodies whose bonds cannot be corrected so. Not collective. */
  template <int dim>
  void require_surface_factors(const BodyParameters<dim> &body);

  /** Collective. */
  template <int dim>
  SurfaceFactors surface_factors(const Families<dim> &bonds,
                                 const Peridynamics  &parameters,
                                 const StoredBonds   &stored);
} // namespace PeriDeal
