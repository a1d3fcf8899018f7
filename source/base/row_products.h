// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <cstddef>
#include <cstdint>

namespace PeriDeal
{
  /**
   * The loops of products with matrices of n x n blocks, n = 1, 2, 3, compiled for several
   * instruction sets. Both of them add in the same order, and never contract, so that a row's value
   * does not depend on which of them found it.
   */
  namespace RowProducts
  {
    /** Numbers of y that are found at once: whole nodes and whole registers, whatever n is. */
    constexpr unsigned int chunk = 24;

    /** Period of the coefficients of along_rows(), at least a register. */
    constexpr unsigned int period(const unsigned int n)
    {
      return n == 3 ? chunk : 8;
    }

    /**
     * y_s = sum over m of c_m[s mod n] x_(s + offset_m), for begin <= s < end: a stencil along rows
     * that are alike. At least one chunk, and begin and end are multiples of n.
     *
     * @param coefficients period(n) of them for each offset
     */
    void along_rows(const unsigned int n,
                    double            *y,
                    const double      *x,
                    const int         *offsets,
                    const double      *coefficients,
                    const unsigned int n_offsets,
                    const std::size_t  begin,
                    const std::size_t  end);

    /**
     * y = sum over k of block_k x_(column_k + shift), for one row of blocks.
     *
     * @param x      of all nodes, interleaved
     * @param blocks column by column, as registers want them
     */
    void one_row(const unsigned int   n,
                 double              *y,
                 const double        *x,
                 const std::uint32_t *columns,
                 const std::uint32_t  shift,
                 const double        *blocks,
                 const unsigned int   n_blocks);
  } // namespace RowProducts
} // namespace PeriDeal
