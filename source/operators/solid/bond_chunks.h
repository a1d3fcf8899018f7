// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <cstddef>

namespace PeriDeal
{
  /**
   * The bonds of some consecutive sites along a row of a lattice, bond by bond of a whole family
   * for all of them at once. Of a number for each site stand `width` in a row. What a bond
   * remembers is a vector: the components one after the other, bonds in the order of the family.
   * The operations on a site do not depend on where in its chunk it is.
   */
  struct BondChunk
  {
    static constexpr int width = 8;

    std::size_t           n_bonds   = 0;
    const std::ptrdiff_t *offsets   = nullptr; // of the far ends in padded grids
    const double         *vectors   = nullptr; // xi
    const double         *weights   = nullptr; // w
    const double         *volumes   = nullptr; // in a padded grid, at the first site
    const double         *values[3] = {};      // displacements, the same
    const double         *slopes    = nullptr; // G of the sites, row by row
  };


  /** What is summed over the bonds of the sites of a chunk, but for the volumes of these. */
  struct ChunkSums
  {
    double squares[BondChunk::width];  // w V_j |z_e|^2
    double products[BondChunk::width]; // w V_j z_e . du
    double pulls[3][BondChunk::width]; // w V_j z_p, or z_e
  };


  /** Of z_e = du - G xi - z_p. */
  template <int dim>
  void sum_elastic(const BondChunk &chunk, const double *plastic, ChunkSums &sums);

  /** z_p grows by so many times z_e. */
  template <int dim>
  void let_flow(const BondChunk &chunk, const double *lost, double *plastic);

  /** Both in one go: let_flow() with what was before, then sum_elastic(). */
  template <int dim>
  void let_flow_and_sum(const BondChunk &before,
                        const double    *lost,
                        const BondChunk &now,
                        double          *plastic,
                        ChunkSums       &sums);

  /** Keep z_e, and sum what it pulls by. */
  template <int dim>
  void keep_elastic(const BondChunk &chunk,
                    const double    *plastic,
                    double          *elastic,
                    ChunkSums       &sums);

  /** The sums of w V_j z_e . du of what has been kept. */
  template <int dim>
  void sum_products(const BondChunk &chunk, const double *elastic, double *products);

  /**
   * Add weight times the factor of the site times what a bond remembers, at its far end.
   * @param to dim padded grids, at the first site
   */
  template <int dim>
  void add_to_far_ends(const BondChunk &chunk,
                       const double    *factors,
                       const double    *remembered,
                       double *const   *to);
} // namespace PeriDeal
