// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/bounding_box.h>

#include <perideal/mesh/nodes.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /**
   * What a process needs the neighbourhood of: its nodes, for their bonds; or its cells and ghost
   * cells, for all bonds that pass through its cells, and all nodes on the way.
   */
  enum class HaloAround
  {
    nodes,
    cells
  };


  /** How far copies of the nodes of other processes reach, and from what. */
  struct HaloNeed
  {
    double     reach  = 0.;
    HaloAround around = HaloAround::nodes;

    bool covers(const HaloNeed &other) const
    {
      return reach >= other.reach &&
             (around == HaloAround::cells || other.around == HaloAround::nodes);
    }

    /** What covers both. */
    HaloNeed joined(const HaloNeed &other) const
    {
      return {std::max(reach, other.reach), around == HaloAround::cells ? around : other.around};
    }
  };


  /**
   * Finds nodes, owned and those of the halo: on a lattice by a table of its sites, elsewhere by a
   * k-d tree. All who have bonds on the same nodes share it (Nodes::search()).
   */
  template <int dim>
  class NodeSearch
  {
  public:
    using Index = typename Lattice<dim>::Index;

    /**
     * The nodes have their halo, and outlive this object.
     * @param halo   of the nodes
     * @param margin sites around the nodes that the table of a lattice has, too
     */
    NodeSearch(const Nodes<dim> &nodes, const HaloNeed &halo, const Index &margin);
    ~NodeSearch();

    /** The nodes lie on a lattice, one per site. */
    bool has_unique_sites() const
    {
      return tree == nullptr;
    }

    /** Local number of the node at a lattice site, or numbers::invalid_unsigned_int. */
    unsigned int node_at(const Index &site) const
    {
      return in_table(site) ? node_of_site[key(site)] : dealii::numbers::invalid_unsigned_int;
    }

    /** Sites of the table, and their numbers in it. */
    bool        in_table(const Index &site) const;
    std::size_t key(const Index &site) const;

    /** By the number of the site. */
    unsigned int operator[](const std::size_t key) const
    {
      return node_of_site[key];
    }

    /**
     * Off the lattice: the nodes within a distance of a point, unordered, with squared distances.
     * @p found is overwritten.
     */
    void within(const dealii::Point<dim>                     &p,
                const double                                  distance,
                std::vector<std::pair<unsigned int, double>> &found) const;

    /** Owned nodes within a distance of some box, in ascending order. */
    std::vector<unsigned int> owned_near(const std::vector<dealii::BoundingBox<dim>> &boxes,
                                         const double distance) const;

    const HaloNeed &halo() const
    {
      return halo_of_nodes;
    }

    /** Sites around the nodes that the table has, too. */
    const Index &margin() const
    {
      return beyond;
    }

    std::size_t memory_consumption() const
    {
      return node_of_site.capacity() * sizeof(unsigned int);
    }

  private:
    struct Tree;

    void make_table();
    void sites_in(const dealii::BoundingBox<dim> &box, std::vector<unsigned int> &found) const;

    const Nodes<dim>         &nodes;
    const HaloNeed            halo_of_nodes;
    const Index               beyond;
    Index                     corner, extent; // of the table
    std::vector<unsigned int> node_of_site;
    std::unique_ptr<Tree>     tree;
  };


  template <int dim>
  inline bool NodeSearch<dim>::in_table(const Index &site) const
  {
    for (unsigned int d = 0; d < dim; ++d)
      if (site[d] < corner[d] || site[d] >= corner[d] + extent[d])
        return false;
    return true;
  }


  template <int dim>
  inline std::size_t NodeSearch<dim>::key(const Index &site) const
  {
    std::size_t number = 0;
    for (unsigned int d = dim; d-- > 0;)
      {
        Assert(site[d] >= corner[d] && site[d] < corner[d] + extent[d], dealii::ExcInternalError());
        number = number * extent[d] + (site[d] - corner[d]);
      }
    return number;
  }
} // namespace PeriDeal
