// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/alike_rows.h>
#include <perideal/base/instantiate.h>
#include <perideal/base/matrix_rows.h>

#include <algorithm>
#include <cmath>

#include "row_products.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    constexpr std::uint32_t none = -1;

    double largest_of(const double *const values, const std::size_t n_values)
    {
      double largest = 0.;
      for (std::size_t k = 0; k < n_values; ++k)
        largest = std::max(largest, std::abs(values[k]));
      return largest;
    }


    /** Of values that are alike the same, but for one in a thousand million. */
    std::uint64_t key_of(const double *const values, const std::size_t n_values)
    {
      const double largest = largest_of(values, n_values),
                   factor  = largest > 0. ? std::ldexp(1., 20) / largest : 0.;
      std::uint64_t key    = n_values;
      for (std::size_t k = 0; k < n_values; ++k)
        key = (key ^ static_cast<std::uint64_t>(std::llround(factor * values[k]))) *
              0x9E3779B97F4A7C15ull;
      return key;
    }


    bool are_alike(const double *const a, const double *const b, const std::size_t n_values)
    {
      constexpr double round_off = 1e-14;
      const double     slack     = round_off * largest_of(a, n_values);
      for (std::size_t k = 0; k < n_values; ++k)
        if (!(std::abs(a[k] - b[k]) <= slack))
          return false;
      return true;
    }
  } // namespace


  template <int n>
  AlikeRows<n>::AlikeRows(const TrilinosWrappers::SparseMatrix &matrix,
                          const Layout                         &nodes,
                          const std::vector<std::uint64_t>     &places)
    : nodes(nodes)
    , values_of(nodes->locally_owned_size())
  {
    Taken row;
    for (unsigned int i = 0; i < values_of.size(); ++i)
      {
        take(matrix, places, i, row);
        put_into_run(i, row);
        Values like;
        like.n_blocks       = row.columns.size();
        like.pattern        = runs.back().pattern;
        like.key            = key_of(row.blocks.data(), row.blocks.size());
        like.fixed          = true;
        std::uint32_t found = find_alike(row.blocks.data(), like);
        if (found == none)
          found = add_values(row.blocks.data(), like);
        values_of[i] = found;
        ++values[found].users;
      }
    make_stencils();
    columns.shrink_to_fit();
    runs.shrink_to_fit();
  }


  template <int n>
  AlikeRows<n>::~AlikeRows() = default;


  template <int n>
  void AlikeRows<n>::take(const TrilinosWrappers::SparseMatrix &matrix,
                          const std::vector<std::uint64_t>     &places,
                          const unsigned int                    node,
                          Taken                                &row) const
  {
    row.order.clear();
    row.columns.clear();
    for_each_entry_of_row(matrix, n * node, [&](const auto column, const double) {
      if (column % n == 0)
        {
          const unsigned int j = nodes->global_to_local(column / n);
          row.order.emplace_back(places[j], j);
        }
    });
    std::sort(row.order.begin(), row.order.end());
    for (const auto &[place, column] : row.order)
      row.columns.push_back(column);
    row.blocks.assign(row.order.size() * n * n, 0.);
    for (unsigned int c = 0; c < n; ++c)
      for_each_entry_of_row(matrix, n * node + c, [&](const auto column, const double value) {
        const unsigned int j = nodes->global_to_local(column / n);
        const auto         k = std::lower_bound(row.order.begin(),
                                        row.order.end(),
                                        std::make_pair(places[j], std::uint32_t(j))) -
                       row.order.begin();
        row.blocks[n * n * k + n * (column % n) + c] = value;
      });
  }


  template <int n>
  void AlikeRows<n>::put_into_run(const unsigned int node, const Taken &row)
  {
    if (!runs.empty() && runs.back().n_blocks == row.columns.size())
      {
        Run        &run   = runs.back();
        const auto *first = columns.data() + run.first_column;
        bool        same  = true;
        for (unsigned int k = 0; k < run.n_blocks && same; ++k)
          same = row.columns[k] == first[k] + (node - run.begin);
        if (same)
          {
            run.end = node + 1;
            return;
          }
      }
    Run run;
    run.begin        = node;
    run.end          = node + 1;
    run.first_column = columns.size();
    run.n_blocks     = row.columns.size();
    run.pattern      = pattern_of(row.columns);
    columns.insert(columns.end(), row.columns.begin(), row.columns.end());
    runs.push_back(run);
  }


  template <int n>
  std::uint32_t AlikeRows<n>::pattern_of(const std::vector<std::uint32_t> &of_row)
  {
    Pattern pattern;
    for (unsigned int k = 0; k < of_row.size(); ++k)
      {
        const bool follows = k > 0 && of_row[k] == of_row[k - 1] + 1;
        pattern.slots.push_back(follows ? pattern.slots.back() + n : pattern.n_slots + n - 1);
        pattern.n_slots = pattern.slots.back() + n;
      }
    for (std::uint32_t p = patterns.size(); p-- > 0;)
      if (patterns[p].slots == pattern.slots)
        return p;
    patterns.push_back(std::move(pattern));
    return patterns.size() - 1;
  }


  template <int n>
  void AlikeRows<n>::make_stencils()
  {
    constexpr int      band     = n - 1;
    constexpr unsigned many     = 4 * RowProducts::chunk / n;
    constexpr unsigned n_period = RowProducts::period(n);
    for (Values &of : values)
      {
        if (of.users < many)
          continue;
        const Pattern &pattern = patterns[of.pattern];
        of.stencil.assign(n_period * pattern.n_slots, 0.);
        for (unsigned int k = 0; k < of.n_blocks; ++k)
          for (unsigned int s = 0; s < n_period; ++s)
            for (int e = 0; e < n; ++e)
              of.stencil[n_period * (pattern.slots[k] + e - s % n) + s] =
                numbers[of.first + n * n * k + n * e + s % n];
      }
    for (Run &run : runs)
      {
        if (n * (run.end - run.begin) < RowProducts::chunk)
          continue;
        const Pattern &pattern = patterns[run.pattern];
        run.first_offset       = offsets.size();
        offsets.resize(offsets.size() + pattern.n_slots);
        for (unsigned int k = 0; k < run.n_blocks; ++k)
          for (int d = -band; d <= band; ++d)
            offsets[run.first_offset + pattern.slots[k] + d] =
              n * (static_cast<int>(columns[run.first_column + k]) - static_cast<int>(run.begin)) +
              d;
        const auto ends = std::minmax_element(offsets.begin() + run.first_offset, offsets.end());
        run.lowest      = *ends.first;
        run.highest     = *ends.second;
      }
  }


  template <int n>
  std::uint32_t AlikeRows<n>::find_alike(const double *blocks, const Values &like) const
  {
    const auto range = by_key.equal_range(like.key);
    for (auto it = range.first; it != range.second; ++it)
      {
        const Values &of = values[it->second];
        if (of.n_blocks == like.n_blocks && of.pattern == like.pattern &&
            are_alike(numbers.data() + of.first, blocks, n * n * like.n_blocks))
          return it->second;
      }
    return none;
  }


  template <int n>
  std::uint32_t AlikeRows<n>::add_values(const double *blocks, const Values &like)
  {
    const std::size_t size  = n * n * like.n_blocks;
    std::uint32_t     which = values.size();
    std::size_t       first = numbers.size();
    const auto        place = std::find_if(unused.begin(), unused.end(), [&](const auto k) {
      return values[k].n_blocks == like.n_blocks;
    });
    if (place != unused.end())
      {
        which  = *place;
        first  = values[which].first;
        *place = unused.back();
        unused.pop_back();
        std::copy(blocks, blocks + size, numbers.begin() + first);
      }
    else
      {
        values.emplace_back();
        numbers.resize(first + size);
        std::copy(blocks, blocks + size, numbers.begin() + first);
      }
    values[which]       = like;
    values[which].first = first;
    if (like.fixed)
      by_key.emplace(like.key, which);
    return which;
  }


  template <int n>
  void AlikeRows<n>::release(const std::uint32_t which)
  {
    Values &of = values[which];
    if (--of.users > 0)
      return;
    const auto range = by_key.equal_range(of.key);
    for (auto it = range.first; of.fixed && it != range.second; ++it)
      if (it->second == which)
        {
          by_key.erase(it);
          break;
        }
    of.stencil = {};
    unused.push_back(which);
  }


  template <int n>
  const typename AlikeRows<n>::Run &AlikeRows<n>::run_of(const unsigned int node) const
  {
    return *std::prev(
      std::upper_bound(runs.begin(), runs.end(), node, [](const unsigned int i, const Run &run) {
        return i < run.begin;
      }));
  }


  template <int n>
  void AlikeRows<n>::add_block(const unsigned int node,
                               const unsigned int column,
                               const double      *block)
  {
    if (values[values_of[node]].fixed)
      {
        // A copy for this row alone; the numbers may move while it is made.
        const std::uint32_t       before = values_of[node];
        const Values             &of     = values[before];
        const std::vector<double> copy(numbers.begin() + of.first,
                                       numbers.begin() + of.first + n * n * of.n_blocks);
        Values                    like;
        like.n_blocks   = of.n_blocks;
        like.pattern    = of.pattern;
        like.users      = 1;
        values_of[node] = add_values(copy.data(), like);
        release(before);
        touched.push_back(node);
      }
    const Run   &run   = run_of(node);
    const auto  *first = columns.data() + run.first_column;
    unsigned int k     = 0;
    while (k < run.n_blocks && first[k] + (node - run.begin) != column)
      ++k;
    Assert(k < run.n_blocks, ExcMessage("No such entry in the pattern."));
    double *const to = numbers.data() + values[values_of[node]].first + n * n * k;
    for (unsigned int s = 0; s < n * n; ++s)
      to[s] += block[s];
  }


  template <int n>
  void AlikeRows<n>::add(const FullMatrix<double>                   &matrix,
                         const std::vector<types::global_dof_index> &unknowns)
  {
    const unsigned int        n_nodes = unknowns.size() / n;
    std::array<double, n * n> block;
    for (unsigned int a = 0; a < n_nodes; ++a)
      for (unsigned int b = 0; b < n_nodes; ++b)
        {
          bool any = false;
          for (unsigned int c = 0; c < n; ++c)
            for (unsigned int e = 0; e < n; ++e)
              {
                block[n * e + c] = matrix(n * a + c, n * b + e);
                any              = any || block[n * e + c] != 0.;
              }
          const auto row = unknowns[n * a] / n, column = unknowns[n * b] / n;
          if (!any)
            continue;
          if (nodes->in_local_range(row))
            add_block(nodes->global_to_local(row), nodes->global_to_local(column), block.data());
          else
            {
              waiting.push_back(row);
              waiting.push_back(column);
              waiting.insert(waiting.end(), block.begin(), block.end());
            }
        }
  }


  template <int n>
  void AlikeRows<n>::compress()
  {
    const MPI_Comm communicator = nodes->get_mpi_communicator();
    if (Utilities::MPI::max(waiting.empty() ? 0 : 1, communicator) > 0)
      {
        for (const auto &list : Utilities::MPI::all_gather(communicator, waiting))
          for (std::size_t k = 0; k < list.size(); k += n * n + 2)
            if (const auto row = static_cast<types::global_dof_index>(list[k]);
                nodes->in_local_range(row))
              add_block(nodes->global_to_local(row),
                        nodes->global_to_local(static_cast<types::global_dof_index>(list[k + 1])),
                        list.data() + k + 2);
        waiting.clear();
      }
    for (const unsigned int node : touched)
      {
        const std::uint32_t own = values_of[node];
        Values             &of  = values[own];
        const double *const at  = numbers.data() + of.first;
        of.key                  = key_of(at, n * n * of.n_blocks);
        if (const std::uint32_t found = find_alike(at, of); found != none)
          {
            values_of[node] = found;
            ++values[found].users;
            release(own);
          }
        else
          {
            of.fixed = true;
            by_key.emplace(of.key, own);
          }
      }
    touched.clear();
  }


  template <int n>
  void AlikeRows<n>::multiply_row(double            *y,
                                  const double      *x,
                                  const Run         &run,
                                  const unsigned int node) const
  {
    RowProducts::one_row(n,
                         y + n * node,
                         x,
                         columns.data() + run.first_column,
                         node - run.begin,
                         numbers.data() + values[values_of[node]].first,
                         run.n_blocks);
  }


  template <int n>
  void AlikeRows<n>::multiply_alike(double             *y,
                                    const double       *x,
                                    const Run          &run,
                                    const std::uint32_t begin,
                                    const std::uint32_t end) const
  {
    // A stencil multiplies, by zero, some numbers next to those of a row: none beyond the vector.
    const int     n_x   = n * (nodes->locally_owned_size() + nodes->n_ghost_indices());
    const int     below = std::max(-run.lowest, 0), above = std::max(run.highest, 0);
    std::uint32_t from  = std::max<int>(begin, (below + n - 1) / n),
                  to    = std::min<int>(end, std::max(n_x - above, 0) / n);
    const auto &stencil = values[values_of[begin]].stencil;
    if (stencil.empty() || to < from || n * (to - from) < RowProducts::chunk)
      from = to = end;
    else
      RowProducts::along_rows(n,
                              y,
                              x,
                              offsets.data() + run.first_offset,
                              stencil.data(),
                              patterns[run.pattern].n_slots,
                              n * from,
                              n * to);
    for (std::uint32_t i = begin; i < from; ++i)
      multiply_row(y, x, run, i);
    for (std::uint32_t i = to; i < end; ++i)
      multiply_row(y, x, run, i);
  }


  template <int n>
  void AlikeRows<n>::multiply(Vector &y, const Vector &x) const
  {
    for (const Run &run : runs)
      for (std::uint32_t i = run.begin; i < run.end;)
        {
          std::uint32_t next = i + 1;
          while (next < run.end && values_of[next] == values_of[i])
            ++next;
          multiply_alike(y.begin(), x.begin(), run, i, next);
          i = next;
        }
  }


  template <int n>
  std::size_t AlikeRows<n>::memory_consumption() const
  {
    std::size_t sum = values_of.capacity() * sizeof(values_of[0]) + runs.capacity() * sizeof(Run) +
                      columns.capacity() * sizeof(columns[0]) +
                      offsets.capacity() * sizeof(offsets[0]) + values.capacity() * sizeof(Values) +
                      numbers.capacity() * sizeof(double);
    for (const Values &of : values)
      sum += of.stencil.capacity() * sizeof(double);
    for (const Pattern &pattern : patterns)
      sum += pattern.slots.capacity() * sizeof(pattern.slots[0]);
    return sum + 4 * by_key.size() * sizeof(std::uint64_t);
  }


  PERIDEAL_INSTANTIATE_CLASS(class AlikeRows);
} // namespace PeriDeal
