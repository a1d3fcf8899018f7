// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// This file wants -O3 -ffp-contract=off.

#include "cell_strains.h"

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
  !defined(__SANITIZE_ADDRESS__)
#  define PERIDEAL_FOR_ALL_VECTORS __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#  define PERIDEAL_FOR_ALL_VECTORS
#endif

namespace PeriDeal
{
  namespace
  {
    template <unsigned int dim>
    inline __attribute__((always_inline)) void squares_of(const double *__restrict__ u,
                                                          const std::uint32_t *corners,
                                                          const double        *slopes,
                                                          const unsigned int   n,
                                                          double *__restrict__ squares)
    {
      double gradients[dim * dim][n_cells_at_once]; // [dim d + e]: du_d/dx_e
      for (unsigned int d = 0; d < dim; ++d)
        for (unsigned int e = 0; e < dim; ++e)
          {
            double *const to = gradients[dim * d + e];
            for (unsigned int k = 0; k < n; ++k)
              to[k] = 0.;
            for (unsigned int v = 0; v < 1u << dim; ++v)
              if (!((v >> e) & 1))
                {
                  const double *const low   = u + dim * corners[v] + d,
                                      *high = u + dim * corners[v | (1u << e)] + d;
                  const double slope        = slopes[e];
                  for (unsigned int k = 0; k < n; ++k)
                    to[k] += slope * (high[dim * k] - low[dim * k]);
                }
          }
      for (unsigned int k = 0; k < n; ++k)
        squares[k] = gradients[0][k] * gradients[0][k];
      for (unsigned int d = 1; d < dim; ++d)
        {
          const double *const own = gradients[dim * d + d];
          for (unsigned int k = 0; k < n; ++k)
            squares[k] += own[k] * own[k];
          for (unsigned int e = 0; e < d; ++e)
            {
              const double *const a = gradients[dim * d + e], *b = gradients[dim * e + d];
              for (unsigned int k = 0; k < n; ++k)
                squares[k] += 0.5 * (a[k] + b[k]) * (a[k] + b[k]);
            }
        }
    }
  } // namespace


  PERIDEAL_FOR_ALL_VECTORS void find_strain_squares(const unsigned int   dim,
                                                    const double        *u,
                                                    const std::uint32_t *corners,
                                                    const double        *slopes,
                                                    const unsigned int   n,
                                                    double              *squares)
  {
    if (dim == 2)
      squares_of<2>(u, corners, slopes, n, squares);
    else if (dim == 3)
      squares_of<3>(u, corners, slopes, n, squares);
    else
      squares_of<1>(u, corners, slopes, n, squares);
  }
} // namespace PeriDeal
