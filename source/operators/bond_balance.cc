// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/operators/bond_operator.h>

#include <algorithm>
#include <map>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    std::string name_of_side(const types::boundary_id id, const bool box)
    {
      return box && id < box_side_names().size() ? box_side_names()[id] : std::to_string(id);
    }
  } // namespace


  template <int dim>
  Balance BondOperator<dim>::balance(const Vector &u, const double t, const bool steady) const
  {
    const Nodes<dim> &nodes      = bonds.nodes();
    const auto       &conditions = scene.boundary_conditions;
    const bool        box        = nodes.lattice().has_value();
    Vector            sums, loads;
    initialize_vector(sums);
    initialize_vector(loads);
    u.update_ghost_values();
    fictitious_values(u, t, outside_values);
    sum_bonds(sums, u, outside_values.data());
    add_loads(loads, t);

    Balance balance;
    for (const auto *list : {&conditions.dirichlet, &conditions.flux, &conditions.convection})
      for (const SideCondition &condition : *list)
        balance.sides[condition.name];
    for (const types::boundary_id side : conditions.symmetry)
      balance.sides[name_of_side(side, box)];

    // Prescribed nodes: what leaves them by their bonds has come in through their side.
    for (const auto &entry : constraints.prescribed_nodes())
      balance.sides[entry.condition->name] += sums.local_element(entry.node);
    // Bonds to fictitious nodes: they carry heat through the side that these lie behind.
    if (!bonds.fictitious().empty())
      {
        std::map<unsigned int, const SideCondition *> prescribed;
        for (const auto &entry : constraints.prescribed_nodes())
          prescribed[entry.node] = entry.condition;
        std::vector<typename Families<dim>::Bond> family;
        for (unsigned int i = 0; i < nodes.n_owned(); ++i)
          {
            const auto site = nodes.lattice()->index(nodes.position(i));
            bool       near = false;
            for (unsigned int d = 0; d < dim; ++d)
              {
                const int reach = static_cast<int>(bonds.reach() / nodes.lattice()->spacing[d]) + 1;
                near = near || site[d] < reach || site[d] >= nodes.lattice()->n_sites[d] - reach;
              }
            if (!near)
              continue;
            bonds.bonds_of(i, family);
            for (const auto &bond : family)
              if (bond.neighbor >= nodes.n_local())
                {
                  const unsigned int f    = bond.neighbor - nodes.n_local();
                  const double       heat = bond.weight * (outside_values[f] - u.local_element(i));
                  balance.sides[name_of_side(bonds.fictitious()[f].side, box)] += heat;
                  // In a prescribed node's own sum already, with the other sign.
                  if (const auto entry = prescribed.find(i); entry != prescribed.end())
                    {
                      balance.sides[name_of_side(bonds.fictitious()[f].side, box)] -= heat;
                      balance.sides[entry->second->name] += heat;
                    }
                }
          }
      }
    for (const SideLoad &load : fluxes)
      balance.sides[load.condition->name] +=
        load.area * load.condition->value.value(nodes.position(load.node), t);
    for (std::size_t k = 0; k < convections.size(); ++k)
      {
        const unsigned int i = convections[k].node;
        balance.sides[convections[k].condition->name] +=
          convection_diagonal[k].second *
          (convections[k].condition->value.value(nodes.position(i), t) - u.local_element(i));
      }
    if (scene.peridynamics.flux_treatment != FluxTreatment::natural)
      for (const BoundaryShare &share : nodes.boundary_shares())
        if (const auto *flux = BoundaryConditions<dim>::find(conditions.flux, share.id);
            flux != nullptr && constraints.kind(share.node) == NodeConstraints<dim>::slave)
          balance.sides[flux->name] +=
            share.area * flux->value.value(nodes.position(share.node), t);

    const Expression &source = scene.initial_and_source.source;
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        balance.content += capacity.local_element(i) * u.local_element(i);
        if (constraints.kind(i) != NodeConstraints<dim>::free)
          continue;
        balance.sources += nodes.volume(i) * source.value(nodes.position(i), t);
        if (!steady)
          balance.stored += loads.local_element(i) - sums.local_element(i);
      }
    if (!steady)
      for (const auto &[node, h] : convection_diagonal)
        balance.stored -= h * u.local_element(node);
    u.set_ghost_state(false);

    for (auto &[name, value] : balance.sides)
      value = Utilities::MPI::sum(value, nodes.communicator());
    balance.sources = Utilities::MPI::sum(balance.sources, nodes.communicator());
    balance.stored  = Utilities::MPI::sum(balance.stored, nodes.communicator());
    balance.content = Utilities::MPI::sum(balance.content, nodes.communicator());
    return balance;
  }


  double Balance::throughput() const
  {
    double sum = std::max(sources, 0.);
    for (const auto &[name, value] : sides)
      sum += std::max(value, 0.);
    return sum;
  }


  double Balance::imbalance() const
  {
    double sum = sources - stored;
    for (const auto &[name, value] : sides)
      sum += value;
    return sum;
  }

  template Balance BondOperator<1>::balance(const Vector &, const double, const bool) const;
  template Balance BondOperator<2>::balance(const Vector &, const double, const bool) const;
  template Balance BondOperator<3>::balance(const Vector &, const double, const bool) const;
} // namespace PeriDeal
