// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// This file is compiled once per SIMD target: Highway includes it again from foreach_target.h. What
// stands between HWY_BEFORE_NAMESPACE and HWY_AFTER_NAMESPACE is compiled for each target, the part
// under HWY_ONCE once. Code of the first kind must not call inline functions of the standard
// library: the linker keeps one copy of those, which might use instructions that the machine does
// not have.
//
// The folder of this file must be on the include path, and it wants -O3.

// SSSE3 has nothing to offer over the baseline here, nor AVX3_DL over AVX3.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL)

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "stencil_tile.cc"
#include <perideal/bonds/stencil_tile.h>

#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace PeriDeal
{
  namespace internal
  {
    namespace HWY_NAMESPACE
    {
      namespace hn = hwy::HWY_NAMESPACE;

      using D = hn::ScalableTag<double>;
      using V = hn::Vec<D>;

      /// A channel with its weights and loads as plain arrays.
      struct StencilFilter
      {
        const double  *source; // in u, at the first point of the first row that the filter reads
        std::ptrdiff_t source_row;
        std::ptrdiff_t shift[4]; // of the loads
        const double  *weights;
        int            reach;
        int            n_loads;
        double        *column;
        const double  *initial; // running sums before this channel ...
        std::ptrdiff_t initial_row;
        double        *result; // ... and after
        std::ptrdiff_t result_row;
        std::ptrdiff_t n_rows;
      };

      // Additions and multiplications are written such that no product meets an addition other than
      // in MulAdd: the compiler has nothing to contract, in whatever function or unrolled copy it
      // meets them.

      HWY_INLINE V add3(const V a, const V b, const V c)
      {
        return hn::Add(hn::Add(a, b), c);
      }

      /// The sum of the shifted rows of a channel at one vector of points.
      template <int n_loads, bool odd>
      HWY_INLINE V load_sum(const double *p, const std::ptrdiff_t *shift)
      {
        const D d;
        const V first = hn::LoadU(d, p + shift[0]);
        if constexpr (n_loads == 1)
          return first;
        else if constexpr (odd && n_loads == 2)
          return hn::Sub(first, hn::LoadU(d, p + shift[1]));
        else if constexpr (odd)
          return hn::Add(hn::Sub(first, hn::LoadU(d, p + shift[1])),
                         hn::Sub(hn::LoadU(d, p + shift[2]), hn::LoadU(d, p + shift[3])));
        else if constexpr (n_loads == 2)
          return hn::Add(first, hn::LoadU(d, p + shift[1]));
        else if constexpr (n_loads == 3)
          return add3(first, hn::LoadU(d, p + shift[1]), hn::LoadU(d, p + shift[2]));
        else
          return hn::Add(hn::Add(first, hn::LoadU(d, p + shift[1])),
                         hn::Add(hn::LoadU(d, p + shift[2]), hn::LoadU(d, p + shift[3])));
      }

      /// sum + w_0 p(y) + sum_b w_b (p(y+b) + p(y-b)) with the window centred at p(y); if odd,
      /// sum + sum_b w_b (p(y+b) - p(y-b)).
      template <int reach, bool odd>
      HWY_INLINE V filter_point(V sum, const V *weights, const V *centre)
      {
        if constexpr (!odd)
          sum = hn::MulAdd(weights[0], centre[0], sum);
        HWY_UNROLL(64)
        for (int b = 1; b <= reach; ++b)
          {
            if constexpr (odd)
              sum = hn::MulAdd(weights[b], hn::Sub(centre[b], centre[-b]), sum);
            else
              sum = hn::MulAdd(weights[b], hn::Add(centre[b], centre[-b]), sum);
          }
        return sum;
      }

      /// Where the filter stands: the next row to be read, and the next rows of sums.
      struct Position
      {
        const double *source;
        const double *initial;
        double       *result;
      };

      /// One row of output at one vector of points.
      template <int reach, int n_loads, bool odd_x, bool odd_y>
      HWY_INLINE void filter_row(const StencilFilter &f, const V *weights, Position &at, V *window)
      {
        const D d;
        window[2 * reach] = load_sum<n_loads, odd_x>(at.source, f.shift);
        const V before    = hn::LoadU(d, at.initial);
        hn::StoreU(filter_point<reach, odd_y>(before, weights, window + reach), d, at.result);
        at.source += f.source_row;
        at.initial += f.initial_row;
        at.result += f.result_row;
        HWY_UNROLL(64)
        for (int i = 0; i < 2 * reach; ++i)
          window[i] = window[i + 1];
      }

      /// Filter a strip of @p n_vectors vectors of points along y, with the window in registers.
      template <int reach, int n_loads, bool odd_x, bool odd_y>
      HWY_NOINLINE void filter_in_registers(const StencilFilter &filter,
                                            const std::ptrdiff_t n_vectors)
      {
        // A copy, which the stores of results cannot alias: its members stay in registers.
        const StencilFilter  f = filter;
        const D              d;
        const std::ptrdiff_t lanes = hn::Lanes(d);
        V                    weights[reach + 1];
        HWY_UNROLL(64)
        for (int b = 0; b <= reach; ++b)
          weights[b] = hn::Set(d, f.weights[b]);

        for (std::ptrdiff_t x = 0; x < n_vectors * lanes; x += lanes)
          {
            Position at = {f.source + x, f.initial + (f.initial_row == 0 ? 0 : x), f.result + x};
            V        window[2 * reach + 1];
            HWY_UNROLL(64)
            for (int i = 0; i < 2 * reach; ++i, at.source += f.source_row)
              window[i] = load_sum<n_loads, odd_x>(at.source, f.shift);
            for (std::ptrdiff_t y = 0; y < f.n_rows; ++y)
              filter_row<reach, n_loads, odd_x, odd_y>(f, weights, at, window);
          }
      }

      /// The same for any reach, with the window in a column of vectors in memory.
      template <int n_loads, bool odd_x, bool odd_y>
      HWY_NOINLINE void filter_in_memory(const StencilFilter &f, const std::ptrdiff_t n_vectors)
      {
        const D              d;
        const std::ptrdiff_t lanes = hn::Lanes(d);
        for (std::ptrdiff_t x = 0; x < n_vectors * lanes; x += lanes)
          {
            for (std::ptrdiff_t y = 0; y < f.n_rows + 2 * f.reach; ++y)
              hn::Store(load_sum<n_loads, odd_x>(f.source + x + y * f.source_row, f.shift),
                        d,
                        f.column + y * lanes);
            for (std::ptrdiff_t y = 0; y < f.n_rows; ++y)
              {
                const double *centre = f.column + (y + f.reach) * lanes;
                V             sum    = hn::LoadU(d, f.initial + x + y * f.initial_row);
                if constexpr (!odd_y)
                  sum = hn::MulAdd(hn::Set(d, f.weights[0]), hn::Load(d, centre), sum);
                for (std::ptrdiff_t b = 1; b <= f.reach; ++b)
                  {
                    const V above = hn::Load(d, centre + b * lanes),
                            below = hn::Load(d, centre - b * lanes);
                    sum           = hn::MulAdd(hn::Set(d, f.weights[b]),
                                     odd_y ? hn::Sub(above, below) : hn::Add(above, below),
                                     sum);
                  }
                hn::StoreU(sum, d, f.result + x + y * f.result_row);
              }
          }
      }

      template <int n_loads, bool odd_x, bool odd_y>
      void filter(const StencilFilter &f, const std::ptrdiff_t n_vectors)
      {
        switch (f.reach)
          {
            case 0:
              return filter_in_registers<0, n_loads, odd_x, odd_y>(f, n_vectors);
            case 1:
              return filter_in_registers<1, n_loads, odd_x, odd_y>(f, n_vectors);
            case 2:
              return filter_in_registers<2, n_loads, odd_x, odd_y>(f, n_vectors);
            case 3:
              return filter_in_registers<3, n_loads, odd_x, odd_y>(f, n_vectors);
            case 4:
              return filter_in_registers<4, n_loads, odd_x, odd_y>(f, n_vectors);
            case 5:
              return filter_in_registers<5, n_loads, odd_x, odd_y>(f, n_vectors);
            case 6:
              return filter_in_registers<6, n_loads, odd_x, odd_y>(f, n_vectors);
            case 7:
              return filter_in_registers<7, n_loads, odd_x, odd_y>(f, n_vectors);
            case 8:
              return filter_in_registers<8, n_loads, odd_x, odd_y>(f, n_vectors);
            default:
              return filter_in_memory<n_loads, odd_x, odd_y>(f, n_vectors);
          }
      }

      template <bool odd_x, bool odd_y>
      void filter(const StencilFilter &f, const std::ptrdiff_t n_vectors)
      {
        if constexpr (odd_x)
          return f.n_loads == 2 ? filter<2, odd_x, odd_y>(f, n_vectors) :
                                  filter<4, odd_x, odd_y>(f, n_vectors);
        else
          switch (f.n_loads)
            {
              case 1:
                return filter<1, odd_x, odd_y>(f, n_vectors);
              case 2:
                return filter<2, odd_x, odd_y>(f, n_vectors);
              case 3:
                return filter<3, odd_x, odd_y>(f, n_vectors);
              default:
                return filter<4, odd_x, odd_y>(f, n_vectors);
            }
      }

      /// to[i] = from[i + shift] + from[i - shift] (odd: their difference), or from[i] if shift is
      /// zero, for i < n. Exactly the n points are read; those that lie @p later ahead are asked
      /// for, as rows are too short for the machine to foresee the next one.
      template <bool odd>
      void fold(const double        *from,
                const std::ptrdiff_t shift,
                const std::ptrdiff_t later,
                const std::ptrdiff_t n,
                double              *to)
      {
        const D              d;
        const std::ptrdiff_t lanes = hn::Lanes(d);
        std::ptrdiff_t       i     = 0;
        if (shift == 0)
          {
            for (; i + lanes <= n; i += lanes)
              {
                hwy::Prefetch(from + i + later);
                hn::StoreU(hn::LoadU(d, from + i), d, to + i);
              }
            for (; i < n; ++i)
              to[i] = from[i];
          }
        else
          {
            for (; i + lanes <= n; i += lanes)
              {
                hwy::Prefetch(from + i + shift + later);
                const V above = hn::LoadU(d, from + i + shift),
                        below = hn::LoadU(d, from + i - shift);
                hn::StoreU(odd ? hn::Sub(above, below) : hn::Add(above, below), d, to + i);
              }
            for (; i < n; ++i)
              to[i] = odd ? from[i + shift] - from[i - shift] : from[i + shift] + from[i - shift];
          }
      }

      /// Fill the rows u_c. Beyond the points that the tile needs, rows are zero for one vector
      /// more.
      void fold_planes(const StencilTile &tile)
      {
        const std::ptrdiff_t reach_x = tile.halo[0], reach_y = tile.halo[1];
        const std::ptrdiff_t n     = tile.n_points + 2 * reach_x;
        const std::ptrdiff_t lanes = hn::Lanes(D());
        for (std::ptrdiff_t y = -reach_y; y < tile.n_rows + reach_y; ++y)
          for (std::ptrdiff_t c = tile.odd[2] ? 1 : 0; c <= tile.halo[2]; ++c)
            {
              double *row = tile.folded + c * tile.folded_fold + (y + reach_y) * tile.folded_row +
                            tile.margin - reach_x;
              (tile.odd[2] ? fold<true> : fold<false>)(tile.origin + y * tile.row_stride - reach_x,
                                                       c * tile.plane_stride,
                                                       3 * tile.row_stride,
                                                       n,
                                                       row);
              for (std::ptrdiff_t i = 0; i < lanes; ++i)
                row[n + i] = 0.;
            }
      }

      /// Apply one channel to a strip that begins at point @p x.
      void apply_channel(const StencilTile    &tile,
                         const StencilChannel &channel,
                         const bool            is_first,
                         const std::ptrdiff_t  x,
                         const std::ptrdiff_t  n_vectors)
      {
        alignas(64) static const double zeros[64] = {};

        StencilFilter f;
        f.reach       = channel.reach;
        f.n_loads     = channel.n_loads;
        f.weights     = tile.weights + channel.first_weight;
        f.source      = tile.folded + (tile.halo[1] - f.reach) * tile.folded_row + tile.margin + x;
        f.source_row  = tile.folded_row;
        f.column      = tile.column;
        f.result      = tile.result + x;
        f.result_row  = tile.result_row;
        f.initial     = (is_first ? zeros : f.result);
        f.initial_row = (is_first ? 0 : f.result_row);
        f.n_rows      = tile.n_rows;
        for (int i = 0; i < channel.n_loads; ++i)
          f.shift[i] = channel.fold[i] * tile.folded_fold + channel.shift[i];
        if (tile.odd[0])
          return tile.odd[1] ? filter<true, true>(f, n_vectors) : filter<true, false>(f, n_vectors);
        else
          return tile.odd[1] ? filter<false, true>(f, n_vectors) :
                               filter<false, false>(f, n_vectors);
      }

      /// A strip of a stencil that reaches along x only, with the sums in registers.
      template <int n_vectors>
      HWY_INLINE void compute_line_strip(const StencilTile &tile,
                                         const double      *source,
                                         double            *result)
      {
        const D              d;
        const std::ptrdiff_t lanes = hn::Lanes(d);
        V                    sum[n_vectors];
        HWY_UNROLL(8)
        for (int v = 0; v < n_vectors; ++v)
          sum[v] = tile.accumulate ? hn::LoadU(d, result + v * lanes) : hn::Zero(d);
        for (std::size_t k = 0; k < tile.n_channels; ++k)
          {
            const StencilChannel &channel = tile.channels[k];
            const V               weight  = hn::Set(d, tile.weights[channel.first_weight]);
            if (channel.n_loads == 1)
              {
                HWY_UNROLL(8)
                for (int v = 0; v < n_vectors; ++v)
                  sum[v] = hn::MulAdd(weight, hn::LoadU(d, source + v * lanes), sum[v]);
              }
            else
              {
                HWY_UNROLL(8)
                for (int v = 0; v < n_vectors; ++v)
                  {
                    const V right = hn::LoadU(d, source + v * lanes + channel.shift[0]),
                            left  = hn::LoadU(d, source + v * lanes + channel.shift[1]);
                    sum[v]        = hn::MulAdd(weight,
                                        tile.odd[0] ? hn::Sub(right, left) : hn::Add(right, left),
                                        sum[v]);
                  }
              }
          }
        HWY_UNROLL(8)
        for (int v = 0; v < n_vectors; ++v)
          hn::StoreU(sum[v], d, result + v * lanes);
      }

      void compute_line(const StencilTile &tile, const std::ptrdiff_t n_vectors)
      {
        constexpr int        strip = 8;
        const std::ptrdiff_t lanes = hn::Lanes(D());
        for (std::ptrdiff_t y = 0; y < tile.n_rows; ++y)
          {
            const double  *source = tile.folded + y * tile.folded_row + tile.margin;
            double        *result = tile.result + y * tile.result_row;
            std::ptrdiff_t v      = 0;
            for (; v + strip <= n_vectors; v += strip)
              compute_line_strip<strip>(tile, source + v * lanes, result + v * lanes);
            for (; v < n_vectors; ++v)
              compute_line_strip<1>(tile, source + v * lanes, result + v * lanes);
          }
      }

      void compute_tile(const StencilTile &tile)
      {
        const std::ptrdiff_t lanes     = hn::Lanes(D());
        const std::ptrdiff_t n_vectors = (tile.n_points + lanes - 1) / lanes;
        fold_planes(tile);
        if (tile.halo[1] == 0 && tile.halo[2] == 0)
          return compute_line(tile, n_vectors);

        // All channels of a narrow strip, whose part of the buffers then stays in the first cache.
        constexpr std::ptrdiff_t strip = 4;
        for (std::ptrdiff_t v = 0; v < n_vectors; v += strip)
          for (std::size_t k = 0; k < tile.n_channels; ++k)
            apply_channel(tile,
                          tile.channels[k],
                          k == 0 && !tile.accumulate,
                          v * lanes,
                          (n_vectors - v < strip ? n_vectors - v : strip));
      }

      const char *target_name()
      {
        return hwy::TargetName(HWY_TARGET);
      }
    } // namespace HWY_NAMESPACE
  }   // namespace internal
} // namespace PeriDeal
HWY_AFTER_NAMESPACE();



#if HWY_ONCE
namespace PeriDeal
{
  namespace internal
  {
    HWY_EXPORT(compute_tile);
    HWY_EXPORT(target_name);

    void compute_stencil_tile(const StencilTile &tile)
    {
      HWY_DYNAMIC_DISPATCH(compute_tile)(tile);
    }



    const char *stencil_target_name()
    {
      return HWY_DYNAMIC_DISPATCH(target_name)();
    }
  } // namespace internal
} // namespace PeriDeal
#endif
