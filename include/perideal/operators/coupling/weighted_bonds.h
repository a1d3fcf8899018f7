// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/coupling/weighted_coupling.h>

#include <vector>

namespace PeriDeal
{
  /** Splice and blending of diffusion: bonds that conduct, weighted. */
  template <int dim>
  class WeightedBonds : public WeightedCoupling<dim>
  {
  public:
    using typename Coupling<dim>::Bond;

    /** As WeightedCoupling. */
    WeightedBonds(Nodes<dim>                &nodes,
                  const BodyParameters<dim> &body,
                  const Zone<dim>           &zone,
                  const CouplingScheme       scheme);

    void bonds_of(const unsigned int node, std::vector<Bond> &bonds) const override;
    void possible_neighbors_of(const unsigned int         node,
                               std::vector<unsigned int> &neighbors) const override;

    void take_conductivities_at(const Vector &u) override
    {
      bonds.conductivities().take_at(u);
    }

  private:
    std::size_t memory_of_bonds() const override
    {
      return bonds.memory_consumption();
    }

    DiffusionBonds<dim> bonds;
  };
} // namespace PeriDeal
