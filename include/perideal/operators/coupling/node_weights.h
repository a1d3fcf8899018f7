// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/dofs/dof_handler.h>

#include <perideal/mesh/nodes.h>
#include <perideal/scene/zone.h>

#include <algorithm>
#include <vector>

namespace PeriDeal
{
  /**
   * What splice and blending give to peridynamics at each node of this process, ghosts too: beta =
   * 1 in the zone, falling linearly to 0 over the overlap outside of it.
   */
  template <int dim>
  class NodeWeights
  {
  public:
    using Cell = typename dealii::DoFHandler<dim>::active_cell_iterator;

    NodeWeights(const Nodes<dim> &nodes, const Zone<dim> &zone, const double overlap)
      : nodes(&nodes)
      , overlap(overlap)
    {
      set(zone);
    }

    /** As the zone is now, and where raised no less. */
    void set(const Zone<dim> &zone)
    {
      weights.resize(nodes->n_local());
      for (unsigned int i = 0; i < weights.size(); ++i)
        weights[i] =
          std::max(zone.weight(nodes->position(i), overlap), raised.empty() ? 0. : raised[i]);
    }

    /** That weight is at least so much from now on. */
    void raise(const unsigned int node, const double weight)
    {
      raised.resize(nodes->n_local(), 0.);
      raised[node]  = std::max(raised[node], weight);
      weights[node] = std::max(weights[node], weight);
    }

    double operator[](const unsigned int node) const
    {
      return weights[node];
    }

    double at(const Cell &cell, const unsigned int vertex) const
    {
      return weights[nodes->partitioner()->global_to_local(cell->vertex_dof_index(vertex, 0))];
    }

    /** Over the vertices of a cell. */
    double mean(const Cell &cell) const
    {
      double sum = 0.;
      for (const unsigned int v : cell->vertex_indices())
        sum += at(cell, v) / cell->n_vertices();
      return sum;
    }

    /** Of the owned nodes those with a weight above 0. */
    double n_owned_in_zone() const
    {
      double n = 0.;
      for (unsigned int i = 0; i < nodes->n_owned(); ++i)
        n += weights[i] > 0.;
      return n;
    }

    std::size_t memory_consumption() const
    {
      return (weights.capacity() + raised.capacity()) * sizeof(double);
    }

  private:
    const Nodes<dim>   *nodes;
    double              overlap;         // a length
    std::vector<double> weights, raised; // the latter empty while none are
  };
} // namespace PeriDeal
