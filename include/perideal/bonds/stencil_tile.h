// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace PeriDeal
{
  namespace internal
  {
    /**
     * One term of the stencil: an input row p, and the symmetric filter over y that is applied to
     * it. The input row is the sum of up to four rows u_c, each shifted in x; of a stencil that is
     * odd in x, the second and the fourth are subtracted.
     */
    struct StencilChannel
    {
      int n_loads;
      int fold[4];  ///< c of the rows that are summed into p, in the order of summation
      int shift[4]; ///< signed shift in x of each of them
      int reach;    ///< of the filter over y
      /// Weight [first_weight + b] belongs to y - b and y + b, b = 0..reach.
      std::size_t first_weight;
    };

    /// A stencil as the vectorised code sees it.
    struct StencilPlan
    {
      std::array<int, 3>          halo;
      std::array<bool, 3>         odd;
      std::vector<StencilChannel> channels;
      std::vector<double>         weights;
    };

    /// A rectangle of points of one plane, and the buffers for it.
    struct StencilTile
    {
      const StencilChannel *channels;
      std::size_t           n_channels;
      const double         *weights;
      std::ptrdiff_t        halo[3];
      bool                  odd[3];
      bool                  accumulate; // add to result

      const double  *origin; // g at the first point of the first row
      std::ptrdiff_t row_stride;
      std::ptrdiff_t plane_stride;
      std::ptrdiff_t max_points; // per row, what the buffers hold
      std::ptrdiff_t n_points;
      std::ptrdiff_t n_rows;
      double        *folded;      // rows -halo[1] .. n_rows + halo[1] of u_0, then of u_1, ...
      std::ptrdiff_t folded_row;  // stride in doubles
      std::ptrdiff_t folded_fold; // from u_c to u_{c+1}
      std::ptrdiff_t margin;      // where in a row of u the first point is; >= halo[0], aligned
      double        *column;      // one vector for each row that a filter reads
      double        *result;
      std::ptrdiff_t result_row;
    };

    /// Compute result from g for the points of a tile, with the best SIMD target of the machine.
    void compute_stencil_tile(const StencilTile &tile);

    /// Name of that target.
    const char *stencil_target_name();
  } // namespace internal
} // namespace PeriDeal
