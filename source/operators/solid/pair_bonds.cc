// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/operators/coupling/exchange_laws.h>
#include <perideal/operators/solid/pair_bonds.h>

#include <algorithm>
#include <cmath>

#include "stretch_fault.h"

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
  std::vector<double> PairBonds<dim>::critical_stretches(const BodyParameters<dim> &body) const
  {
    const Nodes<dim>        &nodes     = this->families.nodes();
    const Material          &material  = body.material;
    const double             of_square = ElasticBonds<dim>::energy_per_square(of_lattice);
    const CellStiffness<dim> law       = ElasticBonds<dim>::stiffness(body);
    std::string              message;
    Vector                   stretches(nodes.partitioner());
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        const Point<dim> &p = nodes.position(i);
        double           &s = stretches.local_element(i);
        s                   = material.critical_stretch ?
                                material.critical_stretch->value(p) :
                                std::sqrt(material.fracture_energy->value(p) / (law.at_first(p) * of_square));
        if (message.empty() && !(s > 0.))
          message = stretch_fault(material.critical_stretch.has_value(), p);
      }
    throw_on_all_if_any(nodes.communicator(), message);
    stretches.update_ghost_values();
    return {stretches.begin(), stretches.begin() + nodes.n_local()};
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
    std::vector<unsigned int> owned;
    for (const unsigned int i : ends)
      if (i < this->families.nodes().n_owned())
        owned.push_back(i);
    std::sort(owned.begin(), owned.end());
    owned.erase(std::unique(owned.begin(), owned.end()), owned.end());
    return owned;
  }


  PERIDEAL_INSTANTIATE_CLASS(class PairBonds);
} // namespace PeriDeal
