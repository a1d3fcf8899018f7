// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/bonds/neighbors.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  Neighbors<dim>::Neighbors(Nodes<dim>               &nodes,
                            const KernelWeights<dim> &weights,
                            const HaloNeed           &halo)
    : own_nodes(nodes)
    , of_bonds(weights)
  {
    prepare_search(nodes, halo, weights.reach_in_sites());
    search = nodes.search();
  }


  template <int dim>
  void Neighbors<dim>::add_outside(std::vector<FictitiousNode<dim>> nodes)
  {
    Assert(beyond.empty() && (has_unique_sites() || nodes.empty()), ExcInternalError());
    beyond = std::move(nodes);
    // Images of ghosts may lie beyond the table, where no owned node has a bond to.
    for (unsigned int f = 0; f < beyond.size(); ++f)
      if (search->in_table(beyond[f].site))
        outside_of_site[search->key(beyond[f].site)].push_back(own_nodes.n_local() + f);
  }


  template <int dim>
  void Neighbors<dim>::within(const Point<dim>                             &p,
                              const double                                  distance,
                              std::vector<std::pair<unsigned int, double>> &found) const
  {
    search->within(p, distance, found);
  }


  template <int dim>
  std::vector<std::pair<unsigned int, double>> Neighbors<dim>::family_of(
    const unsigned int node) const
  {
    std::vector<std::pair<unsigned int, double>> found, family;
    within(own_nodes.position(node), of_bonds.reach() * (1. + 1e-9), found);
    std::vector<std::pair<Tensor<1, dim>, unsigned int>> around;
    around.reserve(found.size());
    for (const auto &[neighbor, square] : found)
      around.emplace_back(bond_vector(node, neighbor), neighbor);
    // In the order of the relative position; of two nodes at the same place the one on the same
    // side of a crack comes first by its crack point.
    std::sort(around.begin(), around.end(), [&](const auto &a, const auto &b) {
      for (unsigned int d = dim; d-- > 0;)
        if (a.first[d] != b.first[d])
          return a.first[d] < b.first[d];
      const Point<dim> pa = own_nodes.crack_point(a.second), pb = own_nodes.crack_point(b.second);
      for (unsigned int d = dim; d-- > 0;)
        if (pa[d] != pb[d])
          return pa[d] < pb[d];
      return a.second < b.second;
    });
    const double tiny = 1e-10 * own_nodes.smallest_spacing();
    for (const auto &[xi, neighbor] : around)
      {
        const double r = xi.norm();
        if (neighbor == node || r <= tiny)
          continue; // the node itself, or its twin across a crack
        double w = 0.;
        if (of_bonds.members().empty())
          w = of_bonds.of_length(r);
        else if (const FamilyMember<dim> *member = of_bonds.find(xi))
          w = member->weight;
        if (w > 0.)
          family.emplace_back(neighbor, w);
      }
    return family;
  }


  template <int dim>
  unsigned int Neighbors<dim>::node_at(const Index &site) const
  {
    return search->node_at(site);
  }


  template <int dim>
  std::vector<unsigned int> Neighbors<dim>::nodes_near(const std::vector<BoundingBox<dim>> &boxes,
                                                       const double distance) const
  {
    return search->owned_near(boxes, distance);
  }


  template <int dim>
  bool Neighbors<dim>::has_unique_sites() const
  {
    return search->has_unique_sites();
  }

  template <int dim>
  std::size_t Neighbors<dim>::memory_consumption() const
  {
    return search->memory_consumption() + beyond.capacity() * sizeof(FictitiousNode<dim>);
  }

  PERIDEAL_INSTANTIATE_CLASS(class Neighbors);
} // namespace PeriDeal
