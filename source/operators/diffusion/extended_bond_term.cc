// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/operators/diffusion/extended_bond_term.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  ExtendedBondTerm<dim>::ExtendedBondTerm(const DiffusionBonds<dim>     &bonds,
                                          const PrescribedValues<dim>   &prescribed,
                                          const BoundaryConditions<dim> &conditions)
    : bonds(bonds)
    , prescribed(prescribed)
    , conditions(conditions)
    , outside(bonds.neighbors().outside().size())
  {}


  template <int dim>
  const std::vector<double> &ExtendedBondTerm<dim>::values(const At &at) const
  {
    const auto &fictitious = bonds.neighbors().outside();
    for (std::size_t f = 0; f < fictitious.size(); ++f)
      {
        outside[f] = fictitious[f].sign * at.u.local_element(fictitious[f].mirror);
        if (!at.is_direction)
          outside[f] += fictitious[f].constant(at.time);
      }
    return outside;
  }


  template <int dim>
  void ExtendedBondTerm<dim>::update_rows(const Rows &rows)
  {
    BondTerm::update_rows(rows);
    if (!outside.empty() && std::any_of(rows.begin(), rows.end(), [&](const unsigned int i) {
          return reaches_outside(i);
        }))
      outside_sums.known = false;
  }


  template <int dim>
  void ExtendedBondTerm<dim>::update_conductivities()
  {
    BondTerm::update_conductivities();
    outside_sums.known = false;
  }


  template <int dim>
  bool ExtendedBondTerm<dim>::reaches_outside(const unsigned int node) const
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
  template <typename Visit>
  void ExtendedBondTerm<dim>::for_each_family(const Visit &visit) const
  {
    std::vector<typename DiffusionBonds<dim>::Bond> family;
    for (unsigned int i = 0; i < bonds.nodes().n_owned(); ++i)
      if (reaches_outside(i))
        {
          bonds.bonds_of(i, family);
          visit(i, family);
        }
  }


  template <int dim>
  void ExtendedBondTerm<dim>::find_sums() const
  {
    const unsigned int n_local = bonds.nodes().n_local();
    outside_sums               = {true, std::vector<double>(outside.size(), 0.), {}};
    for_each_family([&](const unsigned int node, const auto &family) {
      double sum = 0.;
      for (const auto &bond : family)
        if (bond.neighbor >= n_local)
          {
            outside_sums.of_outside[bond.neighbor - n_local] += bond.weight;
            sum += bond.weight;
          }
      outside_sums.of_nodes.emplace_back(node, sum);
    });
  }


  template <int dim>
  void ExtendedBondTerm<dim>::begin(const At &at, double &entering) const
  {
    BondTerm::begin(at, entering);
    values(at);
    if (outside.empty())
      return;
    if (!outside_sums.known)
      find_sums();
    double total = entering;
    for (std::size_t f = 0; f < outside.size(); ++f)
      total += outside_sums.of_outside[f] * outside[f];
    for (const auto &[node, weight] : outside_sums.of_nodes)
      total -= weight * at.u.local_element(node);
    entering = total;
  }


  template <int dim>
  void ExtendedBondTerm<dim>::add_flows(Balance &balance, const At &at) const
  {
    for (const types::boundary_id side : conditions.symmetry)
      balance.sides[conditions.name_of(side)];
    const Nodes<dim> &nodes     = bonds.nodes();
    const auto       &dirichlet = conditions.dirichlet;
    // Which condition prescribes a node, of ghosts too: its number from 1 on.
    Vector condition_of(nodes.partitioner());
    for (const auto &entry : prescribed.entries())
      condition_of.local_element(entry.unknown) =
        1. + static_cast<double>(entry.condition - dirichlet.data());
    condition_of.update_ghost_values();
    if (outside.empty()) // of this process
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
      return given != nullptr ? given->name : conditions.name_of(node.side);
    };
    for_each_family([&](const unsigned int node, const auto &family) {
      for (const auto &bond : family)
        if (bond.neighbor >= nodes.n_local())
          {
            const unsigned int f    = bond.neighbor - nodes.n_local();
            const double       heat = bond.weight * (outside[f] - at.u.local_element(node));
            // In a prescribed node's own sum already, with the other sign.
            const SideCondition *const own = condition(node);
            balance.sides[own != nullptr ? own->name : side_of(bonds.neighbors().outside()[f])] +=
              heat;
          }
    });
  }


  PERIDEAL_INSTANTIATE_CLASS(class ExtendedBondTerm);
} // namespace PeriDeal
