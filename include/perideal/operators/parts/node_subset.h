// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/partitioner.h>

#include <perideal/base/types.h>

#include <memory>
#include <vector>

namespace PeriDeal
{
  /**
   * A few of the nodes of a layout, to which others may be added: vectors that take room for these
   * alone. The nodes that a process owns have places in such vectors in the order in which they
   * were added; behind them come the ghosts that are owned members of other processes.
   */
  class NodeSubset
  {
  public:
    using Layout = std::shared_ptr<const dealii::Utilities::MPI::Partitioner>;

    /** Empty at first. @param n_components of vectors */
    NodeSubset(const Layout &nodes, const unsigned int n_components);

    /** Add owned nodes, each named once; some may be members already. Collective. */
    void add(const std::vector<unsigned int> &owned);

    /** On all processes. */
    bool empty() const
    {
      return scalars == nullptr;
    }

    unsigned int n_owned() const
    {
      return members.size();
    }

    /** The owned node at a place. */
    unsigned int node(const unsigned int place) const
    {
      return members[place];
    }

    /** Of an owned node or a ghost; dealii::numbers::invalid_unsigned_int: it is no member. */
    unsigned int place(const unsigned int node) const
    {
      return empty() ? dealii::numbers::invalid_unsigned_int : places[node];
    }

    /**
     * Make a vector that was fitted before, or is empty, one of the members as they are now: what
     * it had stays, what is new is 0. Ghosts are not set. Not collective.
     */
    void fit_scalars(Vector &v) const
    {
      fit(v, scalars);
    }

    /** The same with all components of each node, interleaved. */
    void fit_vectors(Vector &v) const
    {
      fit(v, vectors);
    }

    std::size_t memory_consumption() const;

  private:
    void        find_places(const std::size_t n_before);
    static void fit(Vector &v, const Layout &layout);

    const Layout              nodes;
    const unsigned int        n_components;
    Layout                    scalars, vectors; // of the members
    std::vector<unsigned int> members;
    std::vector<unsigned int> places; // of all nodes, ghosts included; unless empty()
  };
} // namespace PeriDeal
