// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/bonds/stencil_kernel.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <map>
#include <memory>
#include <new>
#include <stdexcept>

namespace PeriDeal
{
  namespace internal
  {
    namespace
    {
      constexpr std::ptrdiff_t max_lanes = 8;

      /// Length of the rows of a tile, such that the buffer of folded rows stays in the second
      /// cache.
      std::ptrdiff_t tile_length(const StencilPlan &plan)
      {
        constexpr std::ptrdiff_t buffer = 48 * 1024; // doubles
        const std::ptrdiff_t     rows =
          (plan.halo[2] + 1) * (StencilKernel::block_rows + 2 * plan.halo[1]);
        const std::ptrdiff_t n = (buffer / rows - 2 * plan.halo[0]) / 64 * 64;
        return std::clamp<std::ptrdiff_t>(n, 64, 1024);
      }

      struct FreeMemory
      {
        void operator()(double *p) const
        {
          std::free(p);
        }
      };

      /// Cache-line aligned memory of this thread, at least @p size doubles.
      double *scratch_memory(const std::size_t size)
      {
        thread_local std::unique_ptr<double, FreeMemory> memory;
        thread_local std::size_t                         capacity = 0;
        if (capacity < size)
          {
            const std::size_t rounded = (size + 7) / 8 * 8;
            memory.reset();
            capacity = 0;
            memory.reset(static_cast<double *>(std::aligned_alloc(64, rounded * sizeof(double))));
            if (!memory)
              throw std::bad_alloc();
            capacity = rounded;
          }
        return memory.get();
      }

      /// The least row length >= n that is an odd number of cache lines: rows then spread over all
      /// sets.
      std::ptrdiff_t spread_row(const std::ptrdiff_t n)
      {
        return ((n + 7) / 8 | 1) * 8;
      }

      std::ptrdiff_t block_of(const std::ptrdiff_t y)
      {
        constexpr std::ptrdiff_t b = StencilKernel::block_rows;
        return (y >= 0 ? y / b : -((b - 1 - y) / b));
      }

      /// Buffers of a tile of any admitted size, in the memory of this thread.
      StencilTile prepare_tile(const StencilPlan &plan)
      {
        StencilTile tile = {};
        std::copy(plan.halo.begin(), plan.halo.end(), tile.halo);
        tile.max_points                    = tile_length(plan);
        const std::ptrdiff_t n_folded_rows = StencilKernel::block_rows + 2 * tile.halo[1];
        tile.margin                        = (tile.halo[0] + max_lanes - 1) / max_lanes * max_lanes;
        tile.folded_row  = spread_row(tile.margin + tile.max_points + tile.halo[0] + max_lanes);
        tile.folded_fold = n_folded_rows * tile.folded_row;
        tile.result_row  = spread_row(tile.max_points);

        const std::ptrdiff_t folded_size = (tile.halo[2] + 1) * tile.folded_fold;
        const std::ptrdiff_t column_size = n_folded_rows * max_lanes;
        const std::ptrdiff_t result_size = StencilKernel::block_rows * tile.result_row;
        tile.folded                      = scratch_memory(folded_size + column_size + result_size);
        tile.column                      = tile.folded + folded_size;
        tile.result                      = tile.column + column_size;
        return tile;
      }

      void set_plan(const StencilPlan &plan, StencilTile &tile)
      {
        tile.channels   = plan.channels.data();
        tile.n_channels = plan.channels.size();
        tile.weights    = plan.weights.data();
        std::copy(plan.odd.begin(), plan.odd.end(), tile.odd);
      }

      /// The smallest rectangle with all points of @p runs with x_begin <= x < x_end.
      struct Rectangle
      {
        std::ptrdiff_t x_begin, x_end, y_begin, y_end;
      };

      Rectangle bounding_rectangle(const StencilKernel::Run *runs,
                                   const std::size_t         n_runs,
                                   const std::ptrdiff_t      x_begin,
                                   const std::ptrdiff_t      x_end)
      {
        Rectangle box = {x_end, x_begin, PTRDIFF_MAX, PTRDIFF_MIN};
        for (std::size_t i = 0; i < n_runs; ++i)
          {
            const std::ptrdiff_t first = std::max(runs[i].x, x_begin);
            const std::ptrdiff_t last =
              std::min(runs[i].x + static_cast<std::ptrdiff_t>(runs[i].n), x_end);
            if (first < last)
              {
                box.x_begin = std::min(box.x_begin, first);
                box.x_end   = std::max(box.x_end, last);
                box.y_begin = std::min(box.y_begin, runs[i].y);
                box.y_end   = std::max(box.y_end, runs[i].y + 1);
              }
          }
        return box;
      }

      /// Weights over b of every (a,c), trimmed to the last that is not zero.
      using Columns = std::map<std::array<int, 2>, std::vector<double>>;

      bool bitwise_equal(const std::vector<double> &a, const std::vector<double> &b)
      {
        return a.size() == b.size() &&
               std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
      }

      void add_loads(StencilChannel &channel, const int a, const int c)
      {
        for (const int shift : {a, -a})
          {
            channel.fold[channel.n_loads]  = c;
            channel.shift[channel.n_loads] = shift;
            ++channel.n_loads;
            if (a == 0)
              break;
          }
      }

      void build_channels(const Columns &columns, StencilPlan &plan)
      {
        for (const auto &[key, weights] : columns)
          {
            const int  a = key[0], c = key[1];
            const auto mirror = columns.find({{c, a}});
            const bool shared = a != c && plan.odd[0] == plan.odd[2] && mirror != columns.end() &&
                                bitwise_equal(mirror->second, weights);
            if (shared && a < c)
              continue; // comes with (c,a)
            StencilChannel channel = {};
            add_loads(channel, a, c);
            if (shared)
              add_loads(channel, c, a);
            channel.reach        = static_cast<int>(weights.size()) - 1;
            channel.first_weight = plan.weights.size();
            plan.weights.insert(plan.weights.end(), weights.begin(), weights.end());
            plan.channels.push_back(channel);
          }
      }

      void check_offset(const unsigned int        dim,
                        const std::array<int, 3> &offset,
                        const double              weight)
      {
        for (unsigned int i = 0; i < 3; ++i)
          {
            if (offset[i] < 0)
              throw std::invalid_argument(
                "StencilKernel: offsets are |a|, |b|, |c|; one is negative.");
            if (i >= dim && offset[i] != 0)
              throw std::invalid_argument(
                "StencilKernel: an offset leaves the dimension of the lattice.");
          }
        if (!std::isfinite(weight))
          throw std::invalid_argument("StencilKernel: a weight is not finite.");
      }
    } // namespace
  }   // namespace internal



  StencilKernel::StencilKernel(const unsigned int                     dim,
                               const std::vector<std::array<int, 3>> &offsets,
                               const std::vector<double>             &weights,
                               const std::array<bool, 3>             &odd)
    : plan{{{0, 0, 0}}, odd, {}, {}}
    , bonds(0)
  {
    if (dim < 1 || dim > 3)
      throw std::invalid_argument("StencilKernel: the dimension must be 1, 2 or 3.");
    if (offsets.empty() || offsets.size() != weights.size())
      throw std::invalid_argument(
        "StencilKernel: as many weights as offsets are needed, and at least one.");

    std::map<std::array<int, 3>, double> sorted;
    internal::Columns                    columns;
    for (std::size_t i = 0; i < offsets.size(); ++i)
      {
        internal::check_offset(dim, offsets[i], weights[i]);
        if (!sorted.emplace(offsets[i], weights[i]).second)
          throw std::invalid_argument("StencilKernel: an offset occurs twice.");
      }
    for (const auto &[offset, weight] : sorted)
      {
        std::size_t images = 1;
        bool        none   = false;
        for (unsigned int i = 0; i < 3; ++i)
          {
            images *= (offset[i] != 0 ? 2 : 1);
            plan.halo[i] = std::max(plan.halo[i], offset[i]);
            none         = none || (odd[i] && offset[i] == 0);
          }
        bonds += (offset == std::array<int, 3>{{0, 0, 0}} ? 0 : images);
        if (none || weight == 0.)
          continue;
        std::vector<double> &column = columns[{{offset[0], offset[2]}}];
        column.resize(offset[1] + 1, 0.); // b increases within (a,*,c)
        column[offset[1]] = weight;
      }
    internal::build_channels(columns, plan);
  }



  void StencilKernel::apply_block(const Term       *terms,
                                  const std::size_t n_terms,
                                  const Run        *runs,
                                  const std::size_t n_runs)
  {
    internal::StencilTile     tile = internal::prepare_tile(terms[0].kernel->plan);
    const internal::Rectangle all =
      internal::bounding_rectangle(runs, n_runs, PTRDIFF_MIN, PTRDIFF_MAX);
    for (std::ptrdiff_t x = all.x_begin; x < all.x_end; x += tile.max_points)
      {
        const internal::Rectangle box =
          internal::bounding_rectangle(runs, n_runs, x, std::min(x + tile.max_points, all.x_end));
        if (box.x_begin >= box.x_end)
          continue;
        tile.n_points   = box.x_end - box.x_begin;
        tile.n_rows     = box.y_end - box.y_begin;
        tile.accumulate = false;
        for (std::size_t t = 0; t < n_terms; ++t)
          {
            const Grid &grid = terms[t].grid;
            if (terms[t].kernel->plan.channels.empty())
              continue;
            internal::set_plan(terms[t].kernel->plan, tile);
            tile.row_stride   = grid.row_stride;
            tile.plane_stride = grid.plane_stride;
            tile.origin       = grid.data + box.x_begin + box.y_begin * grid.row_stride +
                          runs[0].z * grid.plane_stride;
            internal::compute_stencil_tile(tile);
            tile.accumulate = true;
          }
        if (!tile.accumulate)
          std::fill(tile.result, tile.result + tile.n_rows * tile.result_row, 0.);

        for (std::size_t i = 0; i < n_runs; ++i)
          {
            const Run           &run   = runs[i];
            const std::ptrdiff_t first = std::max(run.x, box.x_begin);
            const std::ptrdiff_t last =
              std::min(run.x + static_cast<std::ptrdiff_t>(run.n), box.x_end);
            if (first < last)
              std::memcpy(run.out + (first - run.x),
                          tile.result + (run.y - box.y_begin) * tile.result_row +
                            (first - box.x_begin),
                          (last - first) * sizeof(double));
          }
      }
  }



  void StencilKernel::row(const Grid &grid, const Run &run) const
  {
    const Term term = {this, grid};
    apply_block(&term, 1, &run, 1);
  }



  void StencilKernel::apply(const Grid &grid, const Run *runs, const std::size_t n_runs) const
  {
    const Term term = {this, grid};
    apply_sum(&term, 1, runs, n_runs);
  }



  void StencilKernel::apply_sum(const Term       *terms,
                                const std::size_t n_terms,
                                const Run        *runs,
                                const std::size_t n_runs)
  {
    for (std::size_t begin = 0, end; begin < n_runs; begin = end)
      {
        const std::ptrdiff_t block = internal::block_of(runs[begin].y);
        for (end = begin + 1; end < n_runs; ++end)
          if (runs[end].z != runs[begin].z || internal::block_of(runs[end].y) != block)
            break;
        apply_block(terms, n_terms, runs + begin, end - begin);
      }
  }



  void StencilKernel::sort_for_reuse(std::vector<Run> &runs)
  {
    std::sort(runs.begin(), runs.end(), [](const Run &a, const Run &b) {
      const std::array<std::ptrdiff_t, 4> key_a = {{internal::block_of(a.y), a.z, a.y, a.x}};
      const std::array<std::ptrdiff_t, 4> key_b = {{internal::block_of(b.y), b.z, b.y, b.x}};
      return key_a < key_b;
    });
  }



  std::string StencilKernel::target()
  {
    return internal::stencil_target_name();
  }
} // namespace PeriDeal
