// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include "lattice_layout.h"

namespace PeriDeal
{
  /**
   * Where the sums of a lattice's nodes are while a group of them is computed: those of all nodes,
   * and a second time those of edge nodes, which are computed apart, in clusters.
   */
  template <int dim>
  class LatticeStretches
  {
  public:
    static constexpr std::uint32_t none = LatticePiece::none;

    /** Consecutive nodes of one run, all of them edge nodes or none. */
    struct Stretch
    {
      std::uint32_t node, n, at; // in the sums of the group
      std::uint32_t edge;        // the first in the list of edge nodes, or none
    };

    /** Ends of the group's parts of lists. */
    struct Group
    {
      std::size_t stretches = 0, clusters = 0;
    };

    /**
     * @param layout  is referred to
     * @param edge_of number of each owned node in the list of edge nodes, or none; these go up
     *                along a run
     */
    LatticeStretches(const LatticeLayout<dim> &layout, const std::vector<std::uint32_t> &edge_of);

    /** The sum of terms at all nodes of a group, to where the stretches say. */
    void apply(const StencilKernel::Term *terms,
               const std::size_t          n_terms,
               const std::size_t          group,
               double                    *to) const;

    /** The same for the edge nodes of a cluster. */
    void apply_to_cluster(const StencilKernel::Term *terms,
                          const std::size_t          n_terms,
                          const std::size_t          cluster,
                          double                    *to) const;

    std::size_t memory_consumption() const;

    std::vector<Group>   groups;
    std::vector<Stretch> list;
    std::size_t          n_sums = 0; // the most that a group has

  private:
    void find_clusters(const std::size_t begin, const std::size_t end);

    const LatticeLayout<dim>  &layout;
    std::vector<std::uint32_t> places, edge_places; // of the runs in the sums of their groups
    std::vector<std::size_t>   clusters; // ends of what is computed together in edge_runs

    mutable std::vector<StencilKernel::Run> runs, edge_runs;
  };
} // namespace PeriDeal
