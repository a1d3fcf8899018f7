// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/laws/elasticity.h>
#include <perideal/operators/solid/zone_bonds.h>

#include <vector>

namespace PeriDeal
{
  /**
   * The state-based families of a blending:
   *
   *   k_i = beta_i b/q_i,   a_i = beta_i c d/(V_i q_i^2),
   *
   * the symbols as in StateOperator, beta the weight of peridynamics (WeightedCoupling): where it
   * is 1, the same forces, and the same critical stretch. Broken bonds are left out of the sums and
   * softened ones count by what they bear, while q_i stays that of the body before, with what its
   * cracks have left (where bonds soften, without its cracks). Bonds of a node are those
   * with a family of which at least one end has a weight.
   */
  template <int dim>
  class FamilyBonds : public ZoneBonds<dim>
  {
  public:
    /** Both have to outlive this object. */
    FamilyBonds(Coupling<dim> &coupling, const BodyParameters<dim> &body, const NodalLaw *law);

    std::function<CrossingEnergy(unsigned int)> crossing_energies(
      const BodyParameters<dim> &of_body) const override;
    void set_rows(const std::vector<unsigned int> &of_nodes,
                  const CrackSideFactors          &factors) override;

    /** Owned nodes within the reach of a family. */
    std::vector<unsigned int> rows_at(const std::vector<unsigned int> &ends) const override;

  protected:
    using ZoneBonds<dim>::coefficients;

    const BreakableZone<dim> &zone;

  private:
    StateLaw law_of(const unsigned int node) const;
    void     set_row_of(const unsigned int node);

    const BodyParameters<dim> &body;
    // Memory of set_row_of().
    std::vector<typename Families<dim>::Member>     family;
    std::vector<typename DiffusionBonds<dim>::Bond> list;
  };
} // namespace PeriDeal
