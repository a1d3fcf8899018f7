// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// This file wants -O3 -ffp-contract=off.

#include "cell_strains.h"

#include <perideal/base/for_all_vectors.h>

namespace PeriDeal
{
  namespace
  {
    template <unsigned int dim>
    PERIDEAL_INLINE void squares_of(const double *__restrict__ u,
                                    const std::uint32_t *corners,
                                    const double        *slopes,
                                    const unsigned int   n,
                                    double *__restrict__ squares)
    {
      constexpr unsigned int n_edges = 1u << (dim - 1);             // of a cell, in each direction
      double                 gradients[dim][dim * n_cells_at_once]; // [e][dim k + d]: du_d/dx_e
      for (unsigned int e = 0; e < dim; ++e)
        {
          const double *low[n_edges], *high[n_edges];
          for (unsigned int v = 0, k = 0; v < 1u << dim; ++v)
            if (!((v >> e) & 1))
              {
                low[k]    = u + dim * corners[v];
                high[k++] = u + dim * corners[v | (1u << e)];
              }
          for (unsigned int s = 0; s < dim * n; ++s)
            {
              double sum = 0.;
              for (unsigned int k = 0; k < n_edges; ++k)
                sum += high[k][s] - low[k][s];
              gradients[e][s] = slopes[e] * sum;
            }
        }
      for (unsigned int k = 0; k < n; ++k)
        {
          double sum = 0.;
          for (unsigned int d = 0; d < dim; ++d)
            {
              sum += gradients[d][dim * k + d] * gradients[d][dim * k + d];
              for (unsigned int e = 0; e < d; ++e)
                {
                  const double shear = gradients[e][dim * k + d] + gradients[d][dim * k + e];
                  sum += 0.5 * shear * shear;
                }
            }
          squares[k] = sum;
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
