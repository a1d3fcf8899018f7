// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/mesh/lattice_sites.h>
#include <perideal/mesh/node_search.h>
#include <perideal/mesh/points_within.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  /** Over the nodes of this process and its halo. */
  template <int dim>
  struct NodeSearch<dim>::Tree
  {
    struct PositionOfNode
    {
      const Point<dim> &operator()(const std::size_t i) const
      {
        return nodes.position(i);
      }

      const Nodes<dim> &nodes;
    };

    explicit Tree(const Nodes<dim> &nodes)
      : points(nodes.n_local(), {nodes})
    {}

    const PointTree<dim, PositionOfNode> points;
  };


  template <int dim>
  NodeSearch<dim>::NodeSearch(const Nodes<dim> &nodes, const HaloNeed &halo, const Index &margin)
    : nodes(nodes)
    , halo_of_nodes(halo)
    , beyond(margin)
  {
    if (nodes.lattice().has_value() && !nodes.has_doubled_nodes())
      make_table();
    else
      tree = std::make_unique<Tree>(nodes);
  }


  template <int dim>
  NodeSearch<dim>::~NodeSearch() = default;


  template <int dim>
  void NodeSearch<dim>::make_table()
  {
    Index low{}, high{};
    for (unsigned int i = 0; i < nodes.n_local(); ++i)
      {
        const Index site = nodes.lattice()->index(nodes.position(i));
        for (unsigned int d = 0; d < dim; ++d)
          {
            low[d]  = i == 0 ? site[d] : std::min(low[d], site[d]);
            high[d] = i == 0 ? site[d] : std::max(high[d], site[d]);
          }
      }
    std::size_t n_sites = 1;
    for (unsigned int d = 0; d < dim; ++d)
      {
        corner[d] = low[d] - std::max(1, beyond[d]);
        extent[d] = high[d] + std::max(1, beyond[d]) + 1 - corner[d];
        n_sites *= extent[d];
      }
    node_of_site.assign(n_sites, numbers::invalid_unsigned_int);
    for (unsigned int i = 0; i < nodes.n_local(); ++i)
      node_of_site[key(nodes.lattice()->index(nodes.position(i)))] = i;
  }


  template <int dim>
  void NodeSearch<dim>::within(const Point<dim>                             &p,
                               const double                                  distance,
                               std::vector<std::pair<unsigned int, double>> &found) const
  {
    found.clear();
    tree->points.find(p, distance, found);
  }


  template <int dim>
  std::vector<unsigned int> NodeSearch<dim>::owned_near(const std::vector<BoundingBox<dim>> &boxes,
                                                        const double distance) const
  {
    std::vector<unsigned int> near;
    for (const BoundingBox<dim> &box : boxes)
      {
        BoundingBox<dim> wide = box;
        wide.extend(distance * (1. + 1e-6));
        if (has_unique_sites())
          sites_in(wide, near);
        else
          for (unsigned int i = 0; i < nodes.n_owned(); ++i)
            if (wide.point_inside(nodes.position(i)))
              near.push_back(i);
      }
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    return near;
  }


  template <int dim>
  void NodeSearch<dim>::sites_in(const BoundingBox<dim>    &box,
                                 std::vector<unsigned int> &found) const
  {
    const Lattice<dim> &lattice = *nodes.lattice();
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
      if (const unsigned int i = node_of_site[key(site)]; i < nodes.n_owned())
        found.push_back(i);
    });
  }


  PERIDEAL_INSTANTIATE_CLASS(class NodeSearch);
} // namespace PeriDeal
