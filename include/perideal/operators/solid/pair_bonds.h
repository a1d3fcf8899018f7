// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/coupling/lattice_bonds.h>
#include <perideal/operators/solid/zone_bonds.h>

#include <vector>

namespace PeriDeal
{
  /**
   * The active bonds of an exchange, each by itself:
   *
   *   K u = sum over bonds of W xi (xi . (u_i - u_j)).
   *
   * The critical stretch s is given, or follows from the fracture energy G by the bonds alone (what
   * is left of the cells releases 3 % of G at most):
   *   G = s^2/2 k V sum over half the family of w x^4 |xi_n|, mean over the axes n,
   * W = k w V_i V_j.
   */
  template <int dim>
  class PairBonds : public ZoneBonds<dim>
  {
  public:
    /** Both have to outlive this object. */
    PairBonds(const Coupling<dim> &coupling, const LatticeBonds<dim> &bonds, const NodalLaw *law);

    std::function<CrossingEnergy(unsigned int)> crossing_energies(
      const BodyParameters<dim> &of_body) const override;
    void set_rows(const std::vector<unsigned int> &of_nodes,
                  const CrackSideFactors          &factors) override;

    /** Owned ones of the ends themselves. */
    std::vector<unsigned int> rows_at(const std::vector<unsigned int> &ends) const override;

  private:
    const Coupling<dim>     &coupling;
    const LatticeBonds<dim> &of_lattice;
  };
} // namespace PeriDeal
