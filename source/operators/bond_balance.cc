// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/operators/bond_operator.h>
#include <perideal/operators/heat_content.h>

#include <algorithm>
#include <map>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void BondOperator<dim>::add_fictitious_heat(const Vector &u, Balance &balance) const
  {
    const Nodes<dim> &nodes     = bonds.nodes();
    const auto       &dirichlet = scene.boundary_conditions.dirichlet;
    // Which condition prescribes a node, of ghosts too: its number from 1 on.
    Vector condition_of(nodes.partitioner());
    for (const auto &entry : constraints->prescribed_nodes())
      condition_of.local_element(entry.node) =
        1. + static_cast<double>(entry.condition - dirichlet.data());
    condition_of.update_ghost_values();
    if (bonds.neighbors().outside().empty()) // of this process
      return;
    const auto condition = [&](const unsigned int node) -> const SideCondition * {
      const auto number = static_cast<std::size_t>(condition_of.local_element(node));
      return number == 0 ? nullptr : &dirichlet[number - 1];
    };
    // The side that heat comes through: the one whose value the fictitious node has, be it mirrored
    // at a symmetry side as well.
    const auto side_of = [&](const FictitiousNode<dim> &node) {
      const SideCondition *const given = node.terms.empty() ? condition(node.mirror) :
                                                              node.terms.back().condition;
      return given != nullptr ? given->name : scene.boundary_conditions.name_of(node.side);
    };
    std::vector<typename DiffusionBonds<dim>::Bond> family;
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        if (!reaches_outside(i))
          continue;
        bonds.bonds_of(i, family);
        for (const auto &bond : family)
          if (bond.neighbor >= nodes.n_local())
            {
              const unsigned int f    = bond.neighbor - nodes.n_local();
              const double       heat = bond.weight * (outside_values[f] - u.local_element(i));
              // In a prescribed node's own sum already, with the other sign.
              const SideCondition *const own = condition(i);
              balance.sides[own != nullptr ? own->name : side_of(bonds.neighbors().outside()[f])] +=
                heat;
            }
      }
  }


  template <int dim>
  void BondOperator<dim>::add_side_heat(const Vector &u, const double t, Balance &balance) const
  {
    const Nodes<dim> &nodes = bonds.nodes();
    for (const SideLoad &load : fluxes)
      balance.sides[load.condition->name] += load.area * load.condition->value.value(load.place, t);
    for (std::size_t k = 0; k < convections.size(); ++k)
      {
        const unsigned int i = convections[k].node;
        balance.sides[convections[k].condition->name] +=
          convection_diagonal[k].second *
          (convections[k].condition->value.value(convections[k].place, t) - u.local_element(i));
      }
    if (!scene.peridynamics.natural_fluxes())
      for (const BoundaryShare &share : nodes.condition_shares())
        if (const auto *flux =
              BoundaryConditions<dim>::find(scene.boundary_conditions.flux, share.id);
            flux != nullptr && constraints->kind(share.node) == NodeConstraints<dim>::slave)
          balance.sides[flux->name] += share.area * flux->value.value(nodes.place_of(share), t);
  }


  template <int dim>
  void BondOperator<dim>::add_crack_heat(const Vector &u, Balance &balance) const
  {
    balance.cracks.assign(scene.cracks.cracks.size(), 0.);
    if (!scene.cracks.conduct())
      return;
    const Nodes<dim>                               &nodes = bonds.nodes();
    std::vector<typename DiffusionBonds<dim>::Bond> family;
    std::vector<std::pair<unsigned int, int>>       crossed;
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        if (!bonds.near_crack(i))
          continue;
        bonds.bonds_of(i, family);
        for (const auto &bond : family)
          if (bond.cut && bond.weight != 0.)
            {
              // A bond between two real nodes comes up at both of its ends; with a self term they
              // differ.
              const bool   real  = bond.neighbor < nodes.n_local();
              const double other = real ? u.local_element(bond.neighbor) :
                                          outside_values[bond.neighbor - nodes.n_local()];
              const double heat  = (real ? 0.5 : 1.) * bond.weight * (other - u.local_element(i));
              bonds.cracks().crossed_cracks(i, bond.neighbor, crossed);
              for (const auto &[crack, side] : crossed)
                balance.cracks[crack] += side * heat;
            }
      }
    for (double &heat : balance.cracks)
      heat = Utilities::MPI::sum(heat, nodes.communicator());
  }


  template <int dim>
  Balance BondOperator<dim>::balance(const Vector &u, const double t, const bool steady) const
  {
    const Nodes<dim> &nodes      = bonds.nodes();
    const auto       &conditions = scene.boundary_conditions;
    Vector            heat,
      loads; // heat: K u - load, what leaves a node by its bonds and does not come from a load
    initialize_vector(heat);
    initialize_vector(loads);
    u.update_ghost_values();
    fictitious_values(u, t, outside_values);
    sum_bonds(heat, u, outside_values.data());
    for (const auto &[node, h] : convection_diagonal)
      heat.local_element(node) += h * u.local_element(node);
    add_loads(loads, t);
    heat -= loads;

    Balance balance;
    for (const auto *list : {&conditions.dirichlet, &conditions.flux, &conditions.convection})
      for (const SideCondition &condition : *list)
        balance.sides[condition.name];
    for (const types::boundary_id side : conditions.symmetry)
      balance.sides[conditions.name_of(side)];
    // In a prescribed node it has come in through the node's side.
    for (const auto &entry : constraints->prescribed_nodes())
      balance.sides[entry.condition->name] += heat.local_element(entry.node);
    add_fictitious_heat(u, balance);
    add_side_heat(u, t, balance);
    add_crack_heat(u, balance);

    const Expression &source = scene.initial_and_source.source;
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        balance.content +=
          nodes.volume(i) * heat_content(scene.material, nodes.position(i), u.local_element(i));
        if (constraints->kind(i) != NodeConstraints<dim>::slave)
          balance.sources += nodes.volume(i) * source.value(nodes.position(i), t);
        if (!steady && constraints->kind(i) == NodeConstraints<dim>::free)
          balance.stored -= heat.local_element(i);
      }
    u.set_ghost_state(false);

    for (auto &[name, value] : balance.sides)
      value = Utilities::MPI::sum(value, nodes.communicator());
    for (double *value : {&balance.sources, &balance.stored, &balance.content})
      *value = Utilities::MPI::sum(*value, nodes.communicator());
    return balance;
  }


  template <int dim>
  double BondOperator<dim>::through_prescribed(const Vector      &y,
                                               const unsigned int begin,
                                               const unsigned int end) const
  {
    double sum = 0.;
    for (auto node = std::lower_bound(held.begin(), held.end(), begin);
         node != held.end() && *node < end;
         ++node)
      if (constraints->kind(*node) == NodeConstraints<dim>::prescribed)
        sum += y.local_element(*node);
    return sum;
  }


  template <int dim>
  double BondOperator<dim>::through_sides(const Vector &x, const double *outside) const
  {
    double sum = 0.;
    for (const auto &[node, h] : convection_diagonal)
      sum -= h * x.local_element(node);
    if (bonds.neighbors().outside().empty())
      return sum;
    if (!outside_sums.known)
      find_outside_sums();
    for (std::size_t f = 0; f < outside_sums.of_outside.size(); ++f)
      sum += outside_sums.of_outside[f] * outside[f];
    for (const auto &[node, weight] : outside_sums.of_nodes)
      sum -= weight * x.local_element(node);
    return sum;
  }


  template <int dim>
  double BondOperator<dim>::through_slaves(const double t) const
  {
    if (scene.peridynamics.natural_fluxes())
      return 0.;
    const Nodes<dim> &nodes = bonds.nodes();
    double            sum   = 0.;
    for (const BoundaryShare &share : nodes.condition_shares())
      if (const auto *flux =
            BoundaryConditions<dim>::find(scene.boundary_conditions.flux, share.id);
          flux != nullptr && constraints->kind(share.node) == NodeConstraints<dim>::slave)
        sum += share.area * flux->value.value(nodes.place_of(share), t);
    return sum;
  }


  template <int dim>
  bool BondOperator<dim>::reaches_outside(const unsigned int node) const
  {
    const Nodes<dim> &nodes = bonds.nodes();
    const auto        site  = nodes.lattice()->index(nodes.position(node));
    for (unsigned int d = 0; d < dim; ++d)
      {
        const int reach =
          static_cast<int>(bonds.weights().reach() / nodes.lattice()->spacing[d]) + 1;
        if (site[d] < reach || site[d] >= nodes.lattice()->n_sites[d] - reach)
          return true;
      }
    return false;
  }


  template <int dim>
  void BondOperator<dim>::find_outside_sums() const
  {
    const unsigned int n_local = bonds.nodes().n_local();
    outside_sums               = OutsideSums();
    outside_sums.known         = true;
    outside_sums.of_outside.assign(bonds.neighbors().outside().size(), 0.);
    std::vector<typename DiffusionBonds<dim>::Bond> family;
    for (unsigned int i = 0; i < bonds.nodes().n_owned(); ++i)
      if (reaches_outside(i))
        {
          bonds.bonds_of(i, family);
          double sum = 0.;
          for (const auto &bond : family)
            if (bond.neighbor >= n_local)
              {
                outside_sums.of_outside[bond.neighbor - n_local] += bond.weight;
                sum += bond.weight;
              }
          outside_sums.of_nodes.emplace_back(i, sum);
        }
  }


#define PERIDEAL_INSTANTIATE(dim)                                                                   \
  template double  BondOperator<dim>::through_prescribed(const Vector &,                            \
                                                        const unsigned int,                        \
                                                        const unsigned int) const;                 \
  template double  BondOperator<dim>::through_sides(const Vector &, const double *) const;          \
  template double  BondOperator<dim>::through_slaves(const double) const;                           \
  template bool    BondOperator<dim>::reaches_outside(const unsigned int) const;                    \
  template void    BondOperator<dim>::add_fictitious_heat(const Vector &, Balance &) const;         \
  template void    BondOperator<dim>::add_side_heat(const Vector &, const double, Balance &) const; \
  template void    BondOperator<dim>::add_crack_heat(const Vector &, Balance &) const;              \
  template Balance BondOperator<dim>::balance(const Vector &, const double, const bool) const;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
