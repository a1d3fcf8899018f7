// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/families.h>
#include <perideal/bonds/stencil_kernel.h>

#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /** Consecutive local nodes on consecutive sites of one row of the lattice. */
  struct LatticePiece
  {
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    std::size_t   slot; // in the padded grid
    std::uint32_t node, n;
    std::uint32_t varying =
      none; // where the values begin in the lists of varying values, or none: then
    double volume = 0., family_sum = 0.; // all nodes of the piece have these

    bool varies() const
    {
      return varying != none;
    }
  };


  /**
   * Where the nodes of a process lie in a padded grid, and in which order they are computed: in
   * groups of a block of rows of one plane (in 1D a stretch of the bar), so that what a group needs
   * of the grid is filled in just before, and its sums are finished while they are in cache.
   *
   * Volumes and the sums of families are constant along most of a row. They are kept once for a
   * piece of a row where they are, and node by node elsewhere: less to store and less to read.
   */
  template <int dim>
  class LatticeLayout
  {
  public:
    using Index = typename Lattice<dim>::Index;

    /** Each number is the end of the group's part of a list. */
    struct Group
    {
      std::size_t fills = 0, runs = 0, pieces = 0, ranges = 0;
    };

    /** @param computed the owned nodes whose sums are wanted; all if empty */
    LatticeLayout(const Families<dim>      &families,
                  const std::array<int, 3> &halo,
                  const std::vector<bool>  &computed = {});

    bool        in_grid(const Index &site) const;
    std::size_t slot(const Index &site) const;
    std::size_t n_slots() const;

    /** The grid as the stencil wants it. */
    StencilKernel::Grid grid(const double *data) const;

    /**
     * Once the values are known: cut pieces where they change. One volume for each local node, one
     * sum for each owned one.
     */
    void set_values(const std::vector<double> &volumes, const std::vector<double> &family_sums);

    double volume(const LatticePiece &piece, const std::uint32_t k) const
    {
      return piece.varies() ? varying_volumes[piece.varying + k] : piece.volume;
    }

    double family_sum(const LatticePiece &piece, const std::uint32_t k) const
    {
      return piece.varies() ? varying_sums[piece.varying + k] : piece.family_sum;
    }

    std::size_t memory_consumption() const;

    std::vector<Group>              groups;
    std::vector<LatticePiece>       fills;  // owned nodes and ghosts, to be copied into the grid
    std::vector<LatticePiece>       pieces; // owned nodes that are computed
    std::vector<StencilKernel::Run> runs;   // the same; `out` is not set
    std::vector<std::uint32_t>      first_nodes;                 // of the runs
    std::vector<std::pair<std::uint32_t, std::uint32_t>> ranges; // of these nodes: begin, end
    std::vector<double>                                  varying_volumes, varying_sums;

  private:
    std::array<std::ptrdiff_t, 3> place(std::size_t slot) const;

    void lay_out_grid(const Families<dim> &families);
    void find_fills(const Families<dim> &families);
    void find_runs(const Families<dim> &families, const std::vector<bool> &computed);
    void find_groups(const Families<dim> &families);
    void order_fills();
    void cut(const LatticePiece        &piece,
             const std::vector<double> &volumes,
             const std::vector<double> *family_sums,
             std::vector<LatticePiece> &list);

    std::array<int, 3> halo;
    Index              corner, extent;
  };
} // namespace PeriDeal
