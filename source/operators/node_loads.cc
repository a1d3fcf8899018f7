// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/operators/node_loads.h>

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
    , varies(source.depends_on_time() || body.boundary_conditions.depends_on_time())
  {
    using Constraints      = NodeConstraints<dim>;
    const bool  natural    = body.peridynamics.natural_fluxes();
    const auto &conditions = body.boundary_conditions;
    for (const BoundaryShare &share : nodes.condition_shares())
      {
        const bool  is_slave   = constraints.kind(share.node) == Constraints::slave;
        const auto *flux       = conditions.find(conditions.flux, share.id);
        const auto *convection = conditions.find(conditions.convection, share.id);
        if (flux != nullptr && (is_slave || natural))
          (is_slave ? of_slaves : fluxes)
            .push_back({share.node, share.area, flux, nodes.place_of(share)});
        if (convection == nullptr || is_slave)
          continue;
        const Point<dim> place = nodes.place_of(share);
        with_convection.push_back(
          {share.node, share.area * convection->coefficient.value(place), convection, place});
      }
    std::stable_sort(with_convection.begin(),
                     with_convection.end(),
                     [](const SideLoad &a, const SideLoad &b) { return a.node < b.node; });
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
    for (const auto *list : {&fluxes, &with_convection})
      for (const SideLoad &load : *list)
        add(load.node, load.factor * load.condition->value.value(load.place, t));
    return sum;
  }


  template <int dim>
  void NodeLoads<dim>::add_convection(Vector            &y,
                                      const Vector      &x,
                                      const unsigned int begin,
                                      const unsigned int end) const
  {
    for (auto load =
           std::lower_bound(with_convection.begin(),
                            with_convection.end(),
                            begin,
                            [](const SideLoad &a, const unsigned int b) { return a.node < b; });
         load != with_convection.end() && load->node < end;
         ++load)
      y.local_element(load->node) += load->factor * x.local_element(load->node);
  }


  template <int dim>
  double NodeLoads<dim>::through_convection(const Vector &u) const
  {
    double sum = 0.;
    for (const SideLoad &load : with_convection)
      sum -= load.factor * u.local_element(load.node);
    return sum;
  }


  template <int dim>
  double NodeLoads<dim>::through_slaves(const double t) const
  {
    double sum = 0.;
    for (const SideLoad &load : of_slaves)
      sum += load.factor * load.condition->value.value(load.place, t);
    return sum;
  }


  template <int dim>
  void NodeLoads<dim>::add_to(Balance &balance, const Vector &u, const double t) const
  {
    const auto value = [t](const SideLoad &load) {
      return load.condition->value.value(load.place, t);
    };
    for (const SideLoad &load : fluxes)
      balance.sides[load.condition->name] += load.factor * value(load);
    for (const SideLoad &load : with_convection)
      balance.sides[load.condition->name] +=
        load.factor * (value(load) - u.local_element(load.node));
    for (const SideLoad &load : of_slaves)
      balance.sides[load.condition->name] += load.factor * value(load);
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      if (constraints.kind(i) != NodeConstraints<dim>::slave)
        balance.sources += nodes.volume(i) * source.value(nodes.position(i), t);
  }


  template class NodeLoads<1>;
  template class NodeLoads<2>;
  template class NodeLoads<3>;
} // namespace PeriDeal
