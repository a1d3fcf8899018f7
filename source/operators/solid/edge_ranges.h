// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

namespace PeriDeal
{
  /**
   * Let the k-th range from least to most, of @p n ranges, take in to[k] - from[k]; the most stand
   * @p n_row numbers behind the least.
   */
  void extend_ranges(const double      *from,
                     const double      *to,
                     const unsigned int n,
                     double            *least,
                     const unsigned int n_row);

  /**
   * The same for rows of @p n_row ranges, one after the other: each has its least, then its most.
   */
  void extend_row_ranges(const double      *from,
                         const double      *to,
                         const unsigned int n_rows,
                         const unsigned int n_row,
                         double            *ranges);
} // namespace PeriDeal
