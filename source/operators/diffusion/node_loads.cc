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
                                transfer.depends_on_temperature() ?
                                  0. :
                                  share.area * transfer.coefficient.value(place),
                                &transfer,
                                place});
      }
    std::stable_sort(relaxing.begin(), relaxing.end(), [](const SideLoad &a, const SideLoad &b) {
      return a.node < b.node;
    });
    if (this->tangents.of_source())
      for_each_source([&](const unsigned int i) { this->curved.push_back(i); });
    else
      for (const SideLoad &load : relaxing)
        if (load.is_curved() && (this->curved.empty() || this->curved.back() != load.node))
          this->curved.push_back(load.node);
    find_coefficients();
    if (!this->varies)
      this->find(0.);
  }


  template <int dim>
  template <typename Visit>
  void NodeLoads<dim>::for_each_source(const Visit &visit) const
  {
    for (unsigned int i = 0; i < nodes.n_owned() && this->any_source; ++i)
      if (constraints.kind(i) != NodeConstraints<dim>::slave)
        visit(i);
  }


  template <int dim>
  void NodeLoads<dim>::find_coefficients()
  {
    const auto   &tangents = this->tangents;
    const bool    known    = tangents.taken_at_all();
    const Vector &T        = tangents.temperatures();
    auto         &list     = this->coefficients;
    list.clear();
    for (SideLoad &load : relaxing)
      {
        if (load.is_curved())
          load.coefficient =
            known ?
              load.area * tangents.slope(*load.transfer, load.place, T.local_element(load.node)) :
              0.;
        list.emplace_back(load.node, load.coefficient);
      }
    if (!known || !tangents.of_source())
      return;
    for_each_source([&](const unsigned int i) {
      list.emplace_back(i, nodes.volume(i) * tangents.slope(nodes.position(i), T.local_element(i)));
    });
    std::stable_sort(list.begin(), list.end(), [](const auto &a, const auto &b) {
      return a.first < b.first;
    });
  }


  template <int dim>
  void NodeLoads<dim>::assemble(const double t) const
  {
    const auto   &tangents = this->tangents;
    const bool    known    = tangents.taken_at_all();
    const Vector &T        = tangents.temperatures();
    const auto    at       = [&](const unsigned int i) { return known ? T.local_element(i) : 0.; };
    Vector       &f        = this->loads;
    if (known || !tangents.of_source())
      for_each_source([&](const unsigned int i) {
        f.local_element(i) += nodes.volume(i) * tangents.given(nodes.position(i), t, at(i));
      });
    for (const auto *list : {&fluxes, &relaxing})
      for (const SideLoad &load : *list)
        if (!load.is_curved())
          f.local_element(load.node) += load.entering(t, 0.);
        else if (known)
          f.local_element(load.node) +=
            load.area * load.transfer->entering(load.place, t, at(load.node)) +
            load.coefficient * at(load.node);
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
    const double undershoot = this->tangents.undershoot_of(u);
    for (const auto *list : {&fluxes, &relaxing, &of_slaves})
      for (const SideLoad &load : *list)
        {
          const double at = u.local_element(load.node);
          balance.sides[load.transfer->name] +=
            load.is_curved() ?
              load.area * this->tangents.entering(*load.transfer, load.place, t, at, undershoot) :
              load.entering(t, at);
        }
    for_each_source([&](const unsigned int i) {
      balance.sources +=
        nodes.volume(i) * this->source.value(nodes.position(i), t, u.local_element(i));
    });
  }


  PERIDEAL_INSTANTIATE_CLASS(class NodeLoads);
} // namespace PeriDeal
