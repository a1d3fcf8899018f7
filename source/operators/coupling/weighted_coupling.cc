// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/operators/coupling/weighted_coupling.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  WeightedCoupling<dim>::WeightedCoupling(Nodes<dim>                &nodes,
                                          const BodyParameters<dim> &body,
                                          const Zone<dim>           &zone,
                                          const CouplingScheme       scheme)
    : Coupling<dim>(nodes, body, zone)
    , overlap(body.coupling.overlap * own_families.weights().horizon())
    , weighting(scheme)
    , weights_now(nodes, this->zone, overlap)
    , weights_at_end(nodes, this->zone_at(body.cracks.end_time), overlap)
  {
    if (!zone.follows_cracks())
      weights_now = weights_at_end;
    if (!zone.follows_stretches()) // else nodes may join anywhere
      throw_if_zone_empty(weights_at_end.n_owned_in_zone(), nodes.communicator());
  }


  template <int dim>
  bool WeightedCoupling<dim>::change_cell(const Cell &cell, FullMatrix<double> &stiffness) const
  {
    const double kept = weighting.of_cell(weights_now.mean(cell));
    if (kept == 1.)
      return false;
    stiffness *= kept;
    return true;
  }


  template <int dim>
  bool WeightedCoupling<dim>::finish_cell(const Cell &cell, FullMatrix<double> &stiffness) const
  {
    const unsigned int n_components = stiffness.m() / cell->n_vertices();
    bool               changed      = false;
    for (unsigned int a = 0; a < stiffness.m(); ++a)
      if (const double kept = weighting.of_cell_row(weights_now.at(cell, a / n_components));
          kept != 1.)
        {
          changed = true;
          for (unsigned int b = 0; b < stiffness.n(); ++b)
            stiffness(a, b) *= kept;
        }
    return changed;
  }


  template <int dim>
  std::vector<BoundingBox<dim>> WeightedCoupling<dim>::joining_by(const double time) const
  {
    std::vector<BoundingBox<dim>> boxes;
    if (!this->zone_follows_cracks())
      return boxes;
    const Zone<dim> then = this->zone_at(time);
    auto changes = own_families.cracks().history().changes(own_families.cracks().now(), time);
    for (BoundingBox<dim> &box : changes)
      box.extend(then.width() + overlap + own_families.nodes().smallest_spacing());
    for (unsigned int i = 0; i < own_families.nodes().n_local(); ++i)
      {
        const Point<dim> &p = own_families.nodes().position(i);
        if (std::any_of(changes.begin(),
                        changes.end(),
                        [&](const auto &box) { return box.point_inside(p); }) &&
            then.weight(p, overlap) > weights_now[i])
          boxes.push_back({{p, p}});
      }
    return boxes;
  }


  template <int dim>
  void WeightedCoupling<dim>::join(const double time)
  {
    this->zone = this->zone_at(time);
    if (this->zone_follows_cracks())
      weights_now.set(this->zone);
  }


  template <int dim>
  std::size_t WeightedCoupling<dim>::memory_consumption() const
  {
    return own_families.memory_consumption() + weights_now.memory_consumption() +
           weights_at_end.memory_consumption() + memory_of_bonds();
  }


  PERIDEAL_INSTANTIATE_CLASS(class WeightedCoupling);
} // namespace PeriDeal
