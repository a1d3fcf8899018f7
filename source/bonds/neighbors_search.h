// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/neighbors.h>

#include <nanoflann.hpp>

namespace PeriDeal
{
  /** A k-d tree over the nodes of this process and its halo, for neighbours off the lattice. */
  template <int dim>
  struct Neighbors<dim>::Search
  {
    explicit Search(const Nodes<dim> &nodes)
      : nodes(nodes)
      , tree(dim, *this, nanoflann::KDTreeSingleIndexAdaptorParams(16))
    {
      tree.buildIndex();
    }

    /** Nodes within a radius of p, unordered, with squared distances. */
    void within(const dealii::Point<dim>                     &p,
                const double                                  radius,
                std::vector<std::pair<unsigned int, double>> &found) const
    {
      double query[dim];
      for (unsigned int d = 0; d < dim; ++d)
        query[d] = p[d];
      found.clear();
      nanoflann::SearchParams parameters;
      parameters.sorted = false;
      tree.radiusSearch(query, radius * radius, found, parameters);
    }

    std::size_t kdtree_get_point_count() const
    {
      return nodes.n_local();
    }

    double kdtree_get_pt(const std::size_t i, const std::size_t d) const
    {
      return nodes.position(i)[d];
    }

    template <typename BoundingBox>
    bool kdtree_get_bbox(BoundingBox &) const
    {
      return false;
    }

    using Tree = nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, Search>,
                                                     Search,
                                                     dim,
                                                     unsigned int>;

    const Nodes<dim> &nodes;
    Tree              tree;
  };
} // namespace PeriDeal
