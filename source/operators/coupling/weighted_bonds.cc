// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/operators/coupling/weighted_bonds.h>

namespace PeriDeal
{
  template <int dim>
  WeightedBonds<dim>::WeightedBonds(Nodes<dim>                &nodes,
                                    const BodyParameters<dim> &body,
                                    const Zone<dim>           &zone,
                                    const CouplingScheme       scheme)
    : WeightedCoupling<dim>(nodes, body, zone, scheme)
    , bonds(this->own_families, body)
  {}


  template <int dim>
  void WeightedBonds<dim>::bonds_of(const unsigned int node, std::vector<Bond> &list) const
  {
    bonds.bonds_of(node, list);
    unsigned int n_kept = 0;
    for (Bond &bond : list)
      {
        const double weight =
          this->weighting.of_bond(this->weights_now[node], this->weights_now[bond.neighbor]);
        bond.weight *= weight;
        bond.intact *= weight;
        if (weight > 0.)
          list[n_kept++] = bond;
      }
    list.resize(n_kept);
  }


  template <int dim>
  void WeightedBonds<dim>::possible_neighbors_of(const unsigned int         node,
                                                 std::vector<unsigned int> &neighbors) const
  {
    std::vector<Bond> list;
    neighbors.clear();
    bonds.bonds_of(node, list);
    for (const Bond &bond : list)
      if (this->weighting.of_bond(this->weights_at_end[node], this->weights_at_end[bond.neighbor]) >
          0.)
        neighbors.push_back(bond.neighbor);
  }


  PERIDEAL_INSTANTIATE_CLASS(class WeightedBonds);
} // namespace PeriDeal
