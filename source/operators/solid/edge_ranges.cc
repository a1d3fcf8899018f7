// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "edge_ranges.h"

#include <perideal/base/for_all_vectors.h>

// Minimum and maximum are exact: any instruction set finds the same numbers.

namespace PeriDeal
{
  namespace
  {
    template <unsigned int n_row>
    PERIDEAL_INLINE void extend_rows(const double *__restrict__ from,
                                     const double *__restrict__ to,
                                     const unsigned int n_rows,
                                     double *__restrict__ ranges)
    {
      for (unsigned int row = 0; row < n_rows; ++row)
        {
          for (unsigned int k = 0; k < n_row; ++k)
            {
              const double difference = to[k] - from[k];
              ranges[k]               = difference < ranges[k] ? difference : ranges[k];
              ranges[n_row + k] = difference > ranges[n_row + k] ? difference : ranges[n_row + k];
            }
          from += n_row;
          to += n_row;
          ranges += 2 * n_row;
        }
    }
  } // namespace


  void extend_ranges(const double      *from,
                     const double      *to,
                     const unsigned int n,
                     double            *least,
                     const unsigned int n_row)
  {
    for (unsigned int k = 0; k < n; ++k)
      {
        const double difference = to[k] - from[k];
        least[k]                = difference < least[k] ? difference : least[k];
        least[n_row + k]        = difference > least[n_row + k] ? difference : least[n_row + k];
      }
  }


  PERIDEAL_FOR_ALL_VECTORS void extend_row_ranges(const double      *from,
                                                  const double      *to,
                                                  const unsigned int n_rows,
                                                  const unsigned int n_row,
                                                  double            *ranges)
  {
    if (n_row == 12)
      extend_rows<12>(from, to, n_rows, ranges);
    else if (n_row == 8)
      extend_rows<8>(from, to, n_rows, ranges);
    else
      extend_rows<4>(from, to, n_rows, ranges);
  }
} // namespace PeriDeal
