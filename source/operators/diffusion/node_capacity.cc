// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/base/worst_trip.h>
#include <perideal/operators/diffusion/heat_content.h>
#include <perideal/operators/diffusion/node_capacity.h>
#include <perideal/scene/not_positive.h>

#include <limits>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  NodeCapacity<dim>::NodeCapacity(const Nodes<dim> &nodes, const BodyParameters<dim> &body)
    : nodes(nodes)
    , body(body)
  {
    diagonal.reinit(nodes.partitioner());
    find(nullptr);
  }


  template <int dim>
  void NodeCapacity<dim>::find(const Vector *u)
  {
    Trip worst;
    if (body.run.steady)
      {
        for (unsigned int i = 0; i < nodes.n_owned(); ++i)
          diagonal.local_element(i) = nodes.volume(i);
        return;
      }
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        const double T       = u != nullptr ?
                                 u->local_element(i) :
                                 body.initial_and_source.initial_value.value(nodes.position(i));
        const double storage = body.material.storage(nodes.position(i), T);
        if (!(storage > 0.))
          keep_lower(worst,
                     not_positive("'Density' times 'Heat capacity'",
                                  storage,
                                  u != nullptr ? T : std::numeric_limits<double>::quiet_NaN(),
                                  nodes.position(i)));
        diagonal.local_element(i) = storage * nodes.volume(i);
      }
    throw_lowest_if_any(nodes.communicator(), worst);
  }


  template <int dim>
  void NodeCapacity<dim>::take_at(const Vector &u)
  {
    if (depends_on_solution())
      find(&u);
  }


  template <int dim>
  void NodeCapacity<dim>::heat_between(Vector &y, const Vector &u, const Vector &v) const
  {
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      y.local_element(i) = depends_on_solution() ?
                             nodes.volume(i) * heat_between_temperatures(body.material,
                                                                         nodes.position(i),
                                                                         u.local_element(i),
                                                                         v.local_element(i)) :
                             diagonal.local_element(i) * (v.local_element(i) - u.local_element(i));
  }


  template <int dim>
  double NodeCapacity<dim>::content(const Vector &u) const
  {
    double heat = 0.;
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      heat += nodes.volume(i) * heat_content(body.material, nodes.position(i), u.local_element(i));
    return heat;
  }


  PERIDEAL_INSTANTIATE_CLASS(class NodeCapacity);
} // namespace PeriDeal
