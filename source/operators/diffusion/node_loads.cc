// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/operators/diffusion/node_loads.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  NodeLoads<dim>::NodeLoads(const Nodes<dim>           &nodes,
                            const NodeConstraints<dim> &constraints,
                            const BodyParameters<dim>  &body)
    : DiffusionLoads<dim>(nodes.partitioner(),
                          body.boundary_conditions,
                          body.initial_and_source.source)
    , nodes(nodes)
    , constraints(constraints)
  {
    using Constraints      = NodeConstraints<dim>;
    const bool  natural    = body.peridynamics.natural_fluxes();
    const auto &conditions = body.boundary_conditions;
    for (const BoundaryShare &share : nodes.condition_shares())
      {
        const bool       is_slave = constraints.kind(share.node) == Constraints::slave;
        const Point<dim> place    = nodes.place_of(share);
        for (const SurfaceTransfer &transfer : conditions.transfers)
          if (transfer.id != share.id)
            continue;
          else if (!transfer.fixes_level() && (is_slave || natural))
            (is_slave ? of_slaves : fluxes)
              .push_back({share.node, share.area, 0., &transfer, place});
          else if (transfer.fixes_level() && !is_slave)
            relaxing.push_back({share.node,
                                share.area,
                                share.area * transfer.coefficient.value(place),
                                &transfer,
                                place});
      }
    std::stable_sort(relaxing.begin(), relaxing.end(), [](const SideLoad &a, const SideLoad &b) {
      return a.node < b.node;
    });
    for (const SideLoad &load : relaxing)
      this->coefficients.emplace_back(load.node, load.coefficient);
    if (!this->varies)
      this->find(0.);
  }


  template <int dim>
  template <typename Visit>
  void NodeLoads<dim>::for_each_source(const double t, const Visit &visit) const
  {
    for (unsigned int i = 0; i < nodes.n_owned() && this->any_source; ++i)
      if (constraints.kind(i) != NodeConstraints<dim>::slave)
        visit(i, nodes.volume(i) * this->source.value(nodes.position(i), t));
  }


  template <int dim>
  void NodeLoads<dim>::assemble(const double t) const
  {
    Vector &f = this->loads;
    for_each_source(t,
                    [&](const unsigned int i, const double heat) { f.local_element(i) += heat; });
    for (const auto *list : {&fluxes, &relaxing})
      for (const SideLoad &load : *list)
        f.local_element(load.node) += load.entering(t, 0.);
  }


  template <int dim>
  double NodeLoads<dim>::through_slaves(const double t) const
  {
    double sum = 0.;
    for (const SideLoad &load : of_slaves)
      sum += load.entering(t, 0.);
    return sum;
  }


  template <int dim>
  void NodeLoads<dim>::add_to(Balance &balance, const Vector &u, const double t) const
  {
    for (const auto *list : {&fluxes, &relaxing, &of_slaves})
      for (const SideLoad &load : *list)
        balance.sides[load.transfer->name] += load.entering(t, u.local_element(load.node));
    for_each_source(t, [&](const unsigned int, const double heat) { balance.sources += heat; });
  }


  PERIDEAL_INSTANTIATE_CLASS(class NodeLoads);
} // namespace PeriDeal
