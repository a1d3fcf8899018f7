// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// This file wants -O3 -ffp-contract=off.

#include "row_products.h"

#include <perideal/base/for_all_vectors.h>

namespace PeriDeal
{
  namespace RowProducts
  {
    namespace
    {
      // One register or several, wherever they are in memory.
      typedef double Pack __attribute__((vector_size(64), aligned(8), may_alias));

      PERIDEAL_INLINE const Pack &pack(const double *const at)
      {
        return *reinterpret_cast<const Pack *>(at);
      }

      template <unsigned int n>
      PERIDEAL_INLINE void along(double *__restrict__ y,
                                 const double *__restrict__ x,
                                 const int *__restrict__ offsets,
                                 const double *__restrict__ coefficients,
                                 const unsigned int n_offsets,
                                 const std::size_t  begin,
                                 const std::size_t  end)
      {
        constexpr unsigned int next = n == 3 ? 8 : 0;
        for (std::size_t s = begin;;)
          {
            Pack          a{}, b{}, c{};
            const double *factor = coefficients;
            for (unsigned int m = 0; m < n_offsets; ++m, factor += period(n))
              {
                const double *const value = x + (static_cast<std::ptrdiff_t>(s) + offsets[m]);
                a += pack(factor) * pack(value);
                b += pack(factor + next) * pack(value + 8);
                c += pack(factor + 2 * next) * pack(value + 16);
              }
            *reinterpret_cast<Pack *>(y + s)      = a;
            *reinterpret_cast<Pack *>(y + s + 8)  = b;
            *reinterpret_cast<Pack *>(y + s + 16) = c;
            if (s + chunk == end)
              return;
            s = s + 2 * chunk <= end ? s + chunk : end - chunk; // the last ones twice
          }
      }

      template <unsigned int n>
      PERIDEAL_INLINE void one(double *__restrict__ y,
                               const double *__restrict__ x,
                               const std::uint32_t *columns,
                               const std::uint32_t  shift,
                               const double        *blocks,
                               const unsigned int   n_blocks)
      {
        double sum[n]{};
        for (unsigned int k = 0; k < n_blocks; ++k, blocks += n * n)
          {
            const double *const value = x + static_cast<std::size_t>(n) * (columns[k] + shift);
            for (unsigned int e = 0; e < n; ++e)
              for (unsigned int c = 0; c < n; ++c)
                sum[c] += blocks[n * e + c] * value[e];
          }
        for (unsigned int c = 0; c < n; ++c)
          y[c] = sum[c];
      }
    } // namespace


    PERIDEAL_FOR_ALL_VECTORS void along_rows(const unsigned int n,
                                             double            *y,
                                             const double      *x,
                                             const int         *offsets,
                                             const double      *coefficients,
                                             const unsigned int n_offsets,
                                             const std::size_t  begin,
                                             const std::size_t  end)
    {
      if (n == 1)
        along<1>(y, x, offsets, coefficients, n_offsets, begin, end);
      else if (n == 2)
        along<2>(y, x, offsets, coefficients, n_offsets, begin, end);
      else
        along<3>(y, x, offsets, coefficients, n_offsets, begin, end);
    }

    void one_row(const unsigned int   n,
                 double              *y,
                 const double        *x,
                 const std::uint32_t *columns,
                 const std::uint32_t  shift,
                 const double        *blocks,
                 const unsigned int   n_blocks)
    {
      (n == 1 ? one<1> : n == 2 ? one<2> : one<3>)(y, x, columns, shift, blocks, n_blocks);
    }
  } // namespace RowProducts
} // namespace PeriDeal
