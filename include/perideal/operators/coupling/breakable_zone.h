// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/dofs/dof_handler.h>

#include <perideal/bonds/bond_state.h>
#include <perideal/bonds/families.h>

#include <algorithm>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace PeriDeal
{
  /**
   * The zone of a coupling as its breaking bonds see it: where they may break, which of them have,
   * and how it grows. Not collective.
   */
  template <int dim>
  class BreakableZone
  {
  public:
    /** A node known here, and the weight of peridynamics that it is to have at least. */
    struct Joining
    {
      unsigned int node;
      double       weight;
    };

    virtual ~BreakableZone() = default;

    virtual const Families<dim> &families_of_bonds() const = 0;

    /** What peridynamics has at a node known here: 0 outside of the zone, 1 where it is alone. */
    virtual double weight_of(const unsigned int node) const = 0;

    /**
     * Elements hold nothing together that a broken bond at this node, owned or a corner of an own
     * cell, parts.
     */
    virtual bool is_free(const unsigned int node) const = 0;

    /** Nor what the bond between an owned node and another one parts. */
    virtual bool may_break(const unsigned int node, const unsigned int neighbor) const = 0;

    /** What the bond between two nodes known here bears from now on; broken: it has lost all. */
    void set_softness(const unsigned int a, const unsigned int b, const BondSoftness &now)
    {
      damaged[key(a, b)] = now;
    }

    BondSoftness softness(const unsigned int a, const unsigned int b) const
    {
      if (damaged.empty())
        return {};
      const auto found = damaged.find(key(a, b));
      return found == damaged.end() ? BondSoftness() : found->second;
    }

    /** Call visit(a, b, softness) for these bonds, in any order. */
    template <typename Visit>
    void for_each_damaged(const Visit &visit) const
    {
      for (const auto &[nodes, now] : damaged)
        visit(static_cast<unsigned int>(nodes >> 32), static_cast<unsigned int>(nodes), now);
    }

    bool is_broken(const unsigned int a, const unsigned int b) const
    {
      return softness(a, b).lost == 1.;
    }

    /** A bond between two vertices of the cell has broken: what parts these cuts an edge of it. */
    bool parts(const typename dealii::DoFHandler<dim>::active_cell_iterator &cell) const
    {
      const auto node = [&](const unsigned int v) {
        return families_of_bonds().nodes().partitioner()->global_to_local(
          cell->vertex_dof_index(v, 0));
      };
      for (unsigned int v = 0; v < cell->n_vertices() && !damaged.empty(); ++v)
        for (unsigned int w = v + 1; w < cell->n_vertices(); ++w)
          if (is_broken(node(v), node(w)))
            return true;
      return false;
    }

    /** Add to a list the nodes that are to join where the body is about to break at a place. */
    virtual void find_joining(const dealii::Point<dim> &place,
                              std::vector<Joining>     &list) const = 0;

    virtual void join_nodes(const std::vector<Joining> &list) = 0;

  protected:
    std::size_t memory_of_marks() const
    {
      return damaged.size() * 5 * sizeof(std::uint64_t);
    }

  private:
    static std::uint64_t key(const unsigned int a, const unsigned int b)
    {
      return (static_cast<std::uint64_t>(std::min(a, b)) << 32) | std::max(a, b);
    }

    std::unordered_map<std::uint64_t, BondSoftness> damaged; // by local numbers of both ends
  };
} // namespace PeriDeal
