// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/bonds/neighbors.h>
#include <perideal/mesh/lattice_sites.h>

#include <algorithm>
#include <cmath>

#include "neighbors_search.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  Neighbors<dim>::Neighbors(Nodes<dim>               &nodes,
                            const KernelWeights<dim> &weights,
                            const double              halo_reach,
                            const HaloAround          around)
    : own_nodes(nodes)
    , of_bonds(weights)
    , on_lattice(nodes.lattice().has_value() && !nodes.has_doubled_nodes())
  {
    add_halo(nodes, halo_reach, around);
    if (on_lattice)
      index_lattice();
    else
      search = std::make_unique<Search>(nodes);
  }


  template <int dim>
  Neighbors<dim>::~Neighbors() = default;


  template <int dim>
  bool Neighbors<dim>::in_table(const Index &site) const
  {
    for (unsigned int d = 0; d < dim; ++d)
      if (site[d] < corner[d] || site[d] >= corner[d] + extent[d])
        return false;
    return true;
  }


  template <int dim>
  void Neighbors<dim>::index_lattice()
  {
    Index low{}, high{};
    for (unsigned int i = 0; i < own_nodes.n_local(); ++i)
      {
        const Index site = own_nodes.lattice()->index(own_nodes.position(i));
        for (unsigned int d = 0; d < dim; ++d)
          {
            low[d]  = i == 0 ? site[d] : std::min(low[d], site[d]);
            high[d] = i == 0 ? site[d] : std::max(high[d], site[d]);
          }
      }
    const Index reach   = of_bonds.reach_in_sites();
    std::size_t n_sites = 1;
    for (unsigned int d = 0; d < dim; ++d)
      {
        corner[d] = low[d] - std::max(1, reach[d]);
        extent[d] = high[d] + std::max(1, reach[d]) + 1 - corner[d];
        n_sites *= extent[d];
      }
    node_of_site.assign(n_sites, numbers::invalid_unsigned_int);
    for (unsigned int i = 0; i < own_nodes.n_local(); ++i)
      node_of_site[site_key(own_nodes.lattice()->index(own_nodes.position(i)))] = i;
  }


  template <int dim>
  void Neighbors<dim>::add_outside(std::vector<FictitiousNode<dim>> nodes)
  {
    Assert(beyond.empty() && (on_lattice || nodes.empty()), ExcInternalError());
    beyond = std::move(nodes);
    // Images of ghosts may lie beyond the table, where no owned node has a bond to.
    for (unsigned int f = 0; f < beyond.size(); ++f)
      if (in_table(beyond[f].site))
        outside_of_site[site_key(beyond[f].site)].push_back(own_nodes.n_local() + f);
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
    return in_table(site) ? node_of_site[site_key(site)] : numbers::invalid_unsigned_int;
  }


  template <int dim>
  std::vector<unsigned int> Neighbors<dim>::nodes_near(const std::vector<BoundingBox<dim>> &boxes,
                                                       const double distance) const
  {
    std::vector<unsigned int> near;
    for (const BoundingBox<dim> &box : boxes)
      {
        BoundingBox<dim> wide = box;
        wide.extend(distance * (1. + 1e-6));
        if (on_lattice)
          sites_in(wide, near);
        else
          for (unsigned int i = 0; i < own_nodes.n_owned(); ++i)
            if (wide.point_inside(own_nodes.position(i)))
              near.push_back(i);
      }
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    return near;
  }


  template <int dim>
  void Neighbors<dim>::sites_in(const BoundingBox<dim> &box, std::vector<unsigned int> &found) const
  {
    const Lattice<dim> &lattice = *own_nodes.lattice();
    Index               first{}, last{};
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double origin = lattice.position(Index{})[d];
        const auto   site   = [&](const double x, const double low, const double high) {
          return static_cast<int>(
            std::clamp(std::floor((x - origin) / lattice.spacing[d]), low, high));
        };
        first[d] = site(box.lower_bound(d), corner[d], corner[d] + extent[d] - 1);
        last[d] =
          site(box.upper_bound(d) + lattice.spacing[d], corner[d], corner[d] + extent[d] - 1);
      }
    for_each_site(first, last, [&](const Index &site) {
      if (const unsigned int i = node_of_site[site_key(site)]; i < own_nodes.n_owned())
        found.push_back(i);
    });
  }


  template <int dim>
  bool Neighbors<dim>::has_unique_sites() const
  {
    return on_lattice;
  }

  template <int dim>
  const Nodes<dim> &Neighbors<dim>::nodes() const
  {
    return own_nodes;
  }

  template <int dim>
  const std::vector<FictitiousNode<dim>> &Neighbors<dim>::outside() const
  {
    return beyond;
  }

  template <int dim>
  const KernelWeights<dim> &Neighbors<dim>::weights() const
  {
    return of_bonds;
  }

  template <int dim>
  std::size_t Neighbors<dim>::memory_consumption() const
  {
    return node_of_site.capacity() * sizeof(unsigned int) +
           beyond.capacity() * sizeof(FictitiousNode<dim>);
  }

  template class Neighbors<1>;
  template class Neighbors<2>;
  template class Neighbors<3>;
} // namespace PeriDeal
