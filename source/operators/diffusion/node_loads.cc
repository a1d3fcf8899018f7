// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/operators/diffusion/node_loads.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  NodeLoads<dim>::NodeLoads(const Nodes<dim>           &nodes,
                            const NodeConstraints<dim> &constraints,
                            const BodyParameters<dim>  &body)
    : nodes(nodes)
    , constraints(constraints)
    , source(body.initial_and_source.source)
    , varies(source.depends_on_time() || body.boundary_conditions.transfers_depend_on_time())
    , values_vary(body.boundary_conditions.depends_on_time())
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
    if (varies)
      return;
    Vector loads(nodes.partitioner());
    kept_sum = add_to(loads, 0.);
    if (std::any_of(loads.begin(), loads.end(), [](const double load) { return load != 0.; }))
      kept.swap(loads);
  }


  template <int dim>
  double NodeLoads<dim>::add_to(Vector &f, const double t) const
  {
    double     sum = 0.;
    const auto add = [&](const unsigned int i, const double load) {
      f.local_element(i) += load;
      if (constraints.kind(i) == NodeConstraints<dim>::free)
        sum += load;
    };
    if (!source.is_constant() || source.value(Point<dim>()) != 0.)
      for (unsigned int i = 0; i < nodes.n_owned(); ++i)
        add(i, nodes.volume(i) * source.value(nodes.position(i), t));
    for (const auto *list : {&fluxes, &relaxing})
      for (const SideLoad &load : *list)
        add(load.node, load.entering(t, 0.));
    return sum;
  }


  template <int dim>
  void NodeLoads<dim>::add_transfer(Vector            &y,
                                    const Vector      &x,
                                    const unsigned int begin,
                                    const unsigned int end) const
  {
    for (auto load =
           std::lower_bound(relaxing.begin(),
                            relaxing.end(),
                            begin,
                            [](const SideLoad &a, const unsigned int b) { return a.node < b; });
         load != relaxing.end() && load->node < end;
         ++load)
      y.local_element(load->node) += load->coefficient * x.local_element(load->node);
  }


  template <int dim>
  double NodeLoads<dim>::through_transfer(const Vector &u) const
  {
    double sum = 0.;
    for (const SideLoad &load : relaxing)
      sum -= load.coefficient * u.local_element(load.node);
    return sum;
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
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      if (constraints.kind(i) != NodeConstraints<dim>::slave)
        balance.sources += nodes.volume(i) * source.value(nodes.position(i), t);
  }


  template class NodeLoads<1>;
  template class NodeLoads<2>;
  template class NodeLoads<3>;
} // namespace PeriDeal
