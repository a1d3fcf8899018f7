// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/operators/weighted_coupling.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  WeightedCoupling<dim>::WeightedCoupling(Nodes<dim>       &nodes,
                                          const Scene<dim> &scene,
                                          const Zone<dim>  &zone)
    : own_families(nodes, scene, HaloAround::cells)
    , bonds(own_families, scene)
    , zone(zone)
    , overlap(scene.coupling.overlap * bonds.weights().horizon())
    , weights_now(nodes, zone, overlap)
    , weights_at_end(weights_now)
  {
    const CrackHistory<dim> &history = bonds.cracks().history();
    Zone<dim>                at_end  = zone;
    at_end.set_cracks(history.pieces(scene.cracks.end_time));
    this->zone.set_cracks(history.pieces(history.representative(0.)));
    weights_now.set(this->zone);
    weights_at_end.set(at_end);
    throw_if_zone_empty(weights_at_end.n_owned_in_zone(), nodes.communicator());
  }


  template <int dim>
  void WeightedCoupling<dim>::bonds_of(const unsigned int node, std::vector<Bond> &list) const
  {
    bonds.bonds_of(node, list);
    unsigned int n_kept = 0;
    for (Bond &bond : list)
      {
        const double weight = bond_weight(weights_now[node], weights_now[bond.neighbor]);
        bond.weight *= weight;
        bond.intact *= weight;
        if (weight > 0.)
          list[n_kept++] = bond;
      }
    list.resize(n_kept);
  }


  template <int dim>
  void WeightedCoupling<dim>::possible_neighbors_of(const unsigned int         node,
                                                    std::vector<unsigned int> &neighbors) const
  {
    std::vector<Bond> list;
    neighbors.clear();
    bonds.bonds_of(node, list);
    for (const Bond &bond : list)
      if (bond_weight(weights_at_end[node], weights_at_end[bond.neighbor]) > 0.)
        neighbors.push_back(bond.neighbor);
  }


  template <int dim>
  std::vector<BoundingBox<dim>> WeightedCoupling<dim>::joining_by(const double time) const
  {
    std::vector<BoundingBox<dim>> boxes;
    if (!zone.follows_cracks())
      return boxes;
    Zone<dim> then = zone;
    then.set_cracks(bonds.cracks().history().pieces(time));
    auto changes = bonds.cracks().history().changes(bonds.cracks().now(), time);
    for (BoundingBox<dim> &box : changes)
      box.extend(zone.width() + overlap + bonds.nodes().smallest_spacing());
    for (unsigned int i = 0; i < bonds.nodes().n_local(); ++i)
      {
        const Point<dim> &p = bonds.nodes().position(i);
        if (std::any_of(changes.begin(),
                        changes.end(),
                        [&](const auto &box) { return box.point_inside(p); }) &&
            then.weight(p, overlap) != weights_now[i])
          boxes.push_back({{p, p}});
      }
    return boxes;
  }


  template <int dim>
  void WeightedCoupling<dim>::set_cracks_of(const double time)
  {
    bonds.cracks().set_time(time);
    zone.set_cracks(bonds.cracks().history().pieces(time));
    if (zone.follows_cracks())
      weights_now.set(zone);
  }


  template <int dim>
  const NodeWeights<dim> &WeightedCoupling<dim>::weights() const
  {
    return weights_now;
  }

  template <int dim>
  bool WeightedCoupling<dim>::in_zone(const unsigned int node) const
  {
    return weights_now[node] > 0.;
  }

  template <int dim>
  const Families<dim> &WeightedCoupling<dim>::families() const
  {
    return own_families;
  }

  template <int dim>
  std::size_t WeightedCoupling<dim>::memory_consumption() const
  {
    return own_families.memory_consumption() + bonds.memory_consumption() +
           weights_now.memory_consumption() + weights_at_end.memory_consumption();
  }


  template <int dim>
  bool Blending<dim>::change_cell(const Cell &cell, FullMatrix<double> &stiffness) const
  {
    const double mean = this->weights().mean(cell);
    if (mean == 0.)
      return false;
    stiffness *= std::max(0., 1. - mean);
    return true;
  }

  template <int dim>
  double Blending<dim>::bond_weight(const double own, const double neighbor) const
  {
    return 0.5 * (own + neighbor);
  }

  template <int dim>
  bool Blending<dim>::symmetric() const
  {
    return true;
  }


  template <int dim>
  bool Splice<dim>::change_cell(const Cell &, FullMatrix<double> &) const
  {
    return false;
  }

  template <int dim>
  void Splice<dim>::finish_cell(const Cell &cell, FullMatrix<double> &stiffness) const
  {
    for (const unsigned int v : cell->vertex_indices())
      {
        const double weight = 1. - this->weights().at(cell, v);
        for (unsigned int b = 0; b < stiffness.n(); ++b)
          stiffness(v, b) *= weight;
      }
  }

  template <int dim>
  double Splice<dim>::bond_weight(const double own, const double) const
  {
    return own;
  }

  template <int dim>
  bool Splice<dim>::symmetric() const
  {
    return false;
  }


#define PERIDEAL_INSTANTIATE(dim)       \
  template class WeightedCoupling<dim>; \
  template class Blending<dim>;         \
  template class Splice<dim>;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
