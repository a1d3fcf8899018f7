// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/families.h>

#include <array>
#include <cstdint>
#include <vector>

namespace PeriDeal
{
  /**
   * Which nodes of a lattice may have a bond that is stretched to its critical stretch, found from
   * the differences of displacements along the edges of the lattice, dim a node, and not from those
   * along its bonds.
   *
   * A bond xi = x n from i to j is a way along edges, |xi_d|/h_d along the axis d, all within the
   * box that i and j span. With a_d the mean of (u(k + e_d) - u(k))/h_d over those along d,
   *
   *   e/x = n . (u_j - u_i)/x = sum_d n_d n . a_d = n . A n,   A = (a_1 ... a_dim).
   *
   * The entries of A lie between the least and the largest difference in the box. With M their mean
   * and R half of what they differ, and |n| the vector of the absolute values,
   *
   *   e/x <= n . M n + |n| . R |n| <= the largest eigenvalues of sym M and of sym R, added,
   *
   * whatever the displacements are. Boxes are taken together for the nodes of a block of 4 sites
   * along each axis. A node in whose family a site has no node, though it is no farther out than
   * the body is, may lack such ways: it is always a suspect.
   *
   * With linear kinematics; a bond's thermal strain takes off at least the least one of its nodes.
   */
  template <int dim>
  class StretchScreen
  {
  public:
    /**
     * Families with unique sites; referred to.
     * @param critical stretches of owned nodes and ghosts; referred to
     * Collective.
     */
    StretchScreen(const Families<dim> &families, const std::vector<double> &critical);

    /**
     * Owned nodes, in ascending order; no other has a bond with e/x above the smaller critical
     * stretch of its ends. Valid until the next call. Allocates nothing. Not collective.
     * @param u            owned and ghost values
     * @param least_strain no node has a thermal strain less than this
     */
    const std::vector<unsigned int> &suspects(const double *u, const double least_strain) const;

    /** Critical stretches are others. */
    void find_limits();

    /** The least critical stretch of the nodes of this process. */
    double least_critical() const
    {
      return least;
    }

    /** The bound on e/x for the bonds of an owned node, of the last call; infinity: none. */
    double bound(const unsigned int node) const;

    /**
     * Whether the bond that is stretched most, of all pairs in the family of an owned node, may
     * reach its critical stretch: errs to the side of yes, by round-off. Arguments as above.
     */
    bool may_reach(const unsigned int node, const double *u, const double least_strain) const;

    std::size_t memory_consumption() const;

  private:
    using Index = typename Lattice<dim>::Index;

    static constexpr int          width    = 4; // of a block, in sites
    static constexpr unsigned int n_slopes = dim * dim;

    /** Consecutive edges along a row of sites, or nodes: (node + k, other + k). */
    struct Run
    {
      unsigned int node, other, n;
      unsigned int block, shift; // of the first one, and how far it is behind the block's begin
    };

    struct Member
    {
      std::ptrdiff_t         key; // of its site, less that of the node
      dealii::Tensor<1, dim> xi;
      double                 square;
    };

    void        lay_out_blocks();
    Index       block_index(const Index &site) const;
    std::size_t block_number(const Index &index) const;
    void        find_runs();
    void        find_irregular();
    bool        is_irregular(const unsigned int i, const Index &low, const Index &high) const;
    template <typename Visit>
    void   for_each_around(const Index &index, const Visit &visit) const; // blocks within reach
    void   find_slopes(const double *u) const;
    void   spread() const;
    double bound_of_block(const std::size_t block) const;
    template <typename Visit>
    void for_each_chunk(const Run &run, const Visit &visit) const;

    const Families<dim>              &families;
    const std::vector<double>        &critical;
    double                            least; // critical stretch
    std::vector<Member>               members;
    Index                             corner, n_blocks, reach; // reach in blocks
    std::array<std::ptrdiff_t, dim>   strides;
    std::size_t                       n_all; // blocks
    std::array<std::vector<Run>, dim> edges;
    std::vector<Run>                  rows;   // of owned nodes
    std::vector<double>               limits; // least critical stretch around, by block
    std::vector<bool>                 always; // some node of the block is irregular

    mutable std::vector<double>                       sums;      // by block: least, largest
    mutable std::array<std::vector<double>, n_slopes> low, high; // by block
    mutable std::vector<double>                       spare;
    mutable std::vector<double>                       bounds; // by block
    mutable std::vector<unsigned int>                 found;
  };
} // namespace PeriDeal
