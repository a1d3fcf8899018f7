// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/operators/coupling/exchange_laws.h>
#include <perideal/operators/solid/pair_bonds.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  PairBonds<dim>::PairBonds(const Coupling<dim>     &coupling,
                            const LatticeBonds<dim> &bonds,
                            const NodalLaw          *law)
    : ZoneBonds<dim>(bonds.families(), law)
    , coupling(coupling)
    , of_lattice(bonds)
  {}


  template <int dim>
  std::function<CrossingEnergy(unsigned int)> PairBonds<dim>::crossing_energies(
    const BodyParameters<dim> &of_body) const
  {
    return [law       = ElasticBonds<dim>::stiffness(of_body),
            of_square = ElasticBonds<dim>::energy_per_square(of_lattice),
            this](const unsigned int i) {
      CrossingEnergy energy;
      energy.extensions = law.at_first(this->families.nodes().position(i)) * of_square;
      return energy;
    };
  }


  template <int dim>
  void PairBonds<dim>::set_rows(const std::vector<unsigned int> &of_nodes,
                                const CrackSideFactors          &factors)
  {
    std::vector<typename Coupling<dim>::Bond> list;
    for (const unsigned int i : of_nodes)
      {
        coupling.bonds_of(i, list);
        for (auto &bond : list)
          bond.weight *= factors.of_bond(i, bond.neighbor);
        this->set_row(i, list);
      }
    this->finish_rows();
  }


  template <int dim>
  std::vector<unsigned int> PairBonds<dim>::rows_at(const std::vector<unsigned int> &ends) const
  {
    return {ends.begin(),
            std::lower_bound(ends.begin(), ends.end(), this->families.nodes().n_owned())};
  }


  PERIDEAL_INSTANTIATE_CLASS(class PairBonds);
} // namespace PeriDeal
