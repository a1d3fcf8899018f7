// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/stencil_tile.h>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * Convolution with a mirror-symmetric stencil on a padded lattice, the regular part of every bond
   * operator:
   *
   *   out(x,y,z) = sum over offsets (a,b,c) of w(|a|,|b|,|c|) g(x+a, y+b, z+c).
   *
   * A stencil may be odd in some coordinates: then the terms also have the signs of these
   * coordinates of their offsets, and where one of them is zero there is no term.
   *
   * **Method.** Mirror images are added before they are multiplied. In 3D, rows are first folded
   * over z into a buffer, u_c(x,y) = g(x,y,z+c) + g(x,y,z-c). Then, for each class of shifts in x,
   * the row p(y) = u_c(x+a,y) + u_c(x-a,y) is formed in a vector register and slides through a
   * window of 2 reach + 1 registers along y, so that each p is used for all rows of the output
   * block that see it: out(y) += w_0 p(y) + sum_b w_b (p(y+b) + p(y-b)). Classes (a,c) and (c,a)
   * whose weights are bitwise equal (any isotropic influence function on a cubic lattice) share one
   * window.
   *
   * **Reproducibility.** The operations at a point, and their order, depend on the stencil and on
   * the SIMD target alone, and not on the run, block, row or vector lane in which the point is
   * computed: however a lattice is cut into runs (among MPI ranks, say), the value at a point is
   * bitwise the same on machines of one SIMD target. Between targets, with and without fused
   * multiply-add, values differ by rounding.
   *
   * **SIMD.** The code is compiled for several instruction sets; the best one that the machine has
   * is chosen at the first call. See target().
   *
   * **Threads.** All const functions may be called at the same time from several threads: scratch
   * memory (about 700 kB, kept until the thread ends) is thread-local, and is allocated at a
   * thread's first call only (again if a stencil with a larger reach comes along).
   */
  class StencilKernel
  {
  public:
    /**
     * A field g on a lattice that is padded with zeros (or with whatever values the nodes beyond
     * have). Value (x,y,z) is data[x + y * row_stride + z * plane_stride]. Coordinates may be
     * negative: `data` points at (0,0,0), wherever that is in the array.
     *
     * For each run that is computed, the points of the box that holds the run, inflated by halo()
     * in each coordinate, must be readable; apply() also reads in between the runs of one
     * block_rows-high block of rows. An array that holds the bounding box of all runs inflated by
     * halo() is always enough: nothing beyond is read, there is no further padding for whole
     * vectors, and nothing need be aligned. Values that are read must be finite, even where no node
     * is (write zeros).
     */
    struct Grid
    {
      const double  *data         = nullptr;
      std::ptrdiff_t row_stride   = 0;
      std::ptrdiff_t plane_stride = 0;
    };

    /**
     * The points (x .. x + n - 1, y, z). Their n values are written to out[0..n), which may not
     * overlap the grid. Use y = z = 0 in 1D and z = 0 in 2D.
     */
    struct Run
    {
      std::ptrdiff_t x   = 0;
      std::ptrdiff_t y   = 0;
      std::ptrdiff_t z   = 0;
      std::size_t    n   = 0;
      double        *out = nullptr;
    };

    /// Runs with the same z and the same floor(y / block_rows) are computed together, see apply().
    static constexpr std::ptrdiff_t block_rows = 32;

    /**
     * Set up the stencil in @p dim dimensions.
     *
     * @p offsets lists |a|, |b|, |c| (zero beyond dim), each combination once, and @p weights the
     * weight of each; a zero coordinate has one image, any other two, so an entry stands for 1 to 8
     * bonds. The offset (0,0,0) is allowed: with it a constant diagonal can be built in.
     *
     * @p odd says in which coordinates the stencil is odd. halo() is that of all offsets, those of
     * no weight included.
     *
     * @throw std::invalid_argument if the lists are of different or zero length, if an offset is
     * negative, occurs twice or leaves the dimension, or if a weight is not finite.
     */
    StencilKernel(const unsigned int                     dim,
                  const std::vector<std::array<int, 3>> &offsets,
                  const std::vector<double>             &weights,
                  const std::array<bool, 3>             &odd = {{false, false, false}});

    /// One run by itself. Same values as apply(), but without sharing work among rows: slower in 2D
    /// and 3D.
    void row(const Grid &grid, const Run &run) const;

    /**
     * Compute many runs, in any order and of any shape. Neighbouring rows share most of their
     * work, so speed depends on the order: consecutive runs in the list with the same z and the
     * same floor(y / block_rows) are taken together. Put them into the order of sort_for_reuse()
     * once.
     */
    void apply(const Grid &grid, const Run *runs, const std::size_t n_runs) const;

    void apply(const Grid &grid, const std::vector<Run> &runs) const
    {
      apply(grid, runs.data(), runs.size());
    }

    /** A stencil and the field that it is applied to. */
    struct Term
    {
      const StencilKernel *kernel;
      Grid                 grid;
    };

    /** The sum of several terms, as apply(), in one go. All have the same halo. */
    static void apply_sum(const Term       *terms,
                          const std::size_t n_terms,
                          const Run        *runs,
                          const std::size_t n_runs);

    /**
     * Sort by floor(y / block_rows), z, y, x: apply() then finds whole blocks, and in 3D walks
     * along z, so that the planes that consecutive blocks have in common stay in cache.
     */
    static void sort_for_reuse(std::vector<Run> &runs);

    /// Largest |a|, |b| and |c| of the stencil: the widths of the padding.
    const std::array<int, 3> &halo() const
    {
      return plan.halo;
    }

    /// Number of offsets, all mirror images counted, without (0,0,0): bonds of a node.
    std::size_t n_bonds() const
    {
      return bonds;
    }

    /// Number of multiplications at a point that are left after folding.
    std::size_t n_multiplications() const
    {
      return plan.weights.size();
    }

    /// Name of the SIMD target in use, such as "AVX2" or "AVX3" (AVX-512).
    static std::string target();

  private:
    static void apply_block(const Term       *terms,
                            const std::size_t n_terms,
                            const Run        *runs,
                            const std::size_t n_runs);

    internal::StencilPlan plan;
    std::size_t           bonds;
  };
} // namespace PeriDeal
