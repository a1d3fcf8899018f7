// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "lattice_stretches.h"

#include <perideal/base/instantiate.h>

#include <algorithm>
#include <map>
#include <tuple>

namespace PeriDeal
{
  template <int dim>
  LatticeStretches<dim>::LatticeStretches(const LatticeLayout<dim>         &layout,
                                          const std::vector<std::uint32_t> &edge_of)
    : layout(layout)
    , runs(layout.runs)
  {
    std::size_t run = 0;
    for (const auto &group : layout.groups)
      {
        std::map<std::array<std::ptrdiff_t, 3>, std::uint32_t> places_of; // of edge runs
        std::uint32_t                                          at = 0;
        for (; run < group.runs; ++run)
          {
            places.push_back(at);
            const std::uint32_t node = layout.first_nodes[run],
                                n    = static_cast<std::uint32_t>(runs[run].n);
            for (std::uint32_t k = 0; k < n; ++k)
              {
                const std::uint32_t edge    = edge_of[node + k];
                Stretch            *last    = k > 0 ? &list.back() : nullptr;
                const bool          goes_on = last != nullptr &&
                                     (edge == none ?
                                        last->edge == none :
                                        last->edge != none && last->edge + last->n == edge);
                if (goes_on)
                  ++last->n;
                else
                  {
                    list.push_back({node + k, 1, at + k, edge});
                    if (edge != none)
                      {
                        StencilKernel::Run part = runs[run];
                        part.x += k;
                        edge_runs.push_back(part);
                        places_of[{part.x, part.y, part.z}] = at + k;
                      }
                  }
                if (edge != none)
                  edge_runs.back().n = list.back().n;
              }
            at += n;
          }
        find_clusters(clusters.empty() ? 0 : clusters.back(), edge_runs.size());
        for (std::size_t k = edge_places.size(); k < edge_runs.size(); ++k)
          edge_places.push_back(places_of.at({edge_runs[k].x, edge_runs[k].y, edge_runs[k].z}));
        groups.push_back({list.size(), clusters.size()});
        n_sums = std::max<std::size_t>(n_sums, at);
      }
    list.shrink_to_fit();
  }


  /**
   * Edge runs of a group are computed in rectangles, what lies between them too: cut the group
   * where that saves work. Neither part of a cut shares a row, or neither a column.
   */
  template <int dim>
  void LatticeStretches<dim>::find_clusters(const std::size_t begin, const std::size_t end)
  {
    if (begin == end)
      return;
    const auto first = edge_runs.begin() + begin, last = edge_runs.begin() + end;
    const auto cost = [&](const auto from, const auto to) {
      std::ptrdiff_t low[2] = {from->x, from->y}, high[2] = {from->x, from->y};
      for (auto run = from; run != to; ++run)
        {
          low[0]  = std::min(low[0], run->x);
          high[0] = std::max(high[0], run->x + static_cast<std::ptrdiff_t>(run->n));
          low[1]  = std::min(low[1], run->y);
          high[1] = std::max(high[1], run->y + 1);
        }
      return (high[0] - low[0] + 8.) * (high[1] - low[1] + 4.);
    };
    const auto by_column = [](const auto &a, const auto &b) {
      return std::tie(a.x, a.y) < std::tie(b.x, b.y);
    };
    const auto by_row = [](const auto &a, const auto &b) {
      return std::tie(a.y, a.x) < std::tie(b.y, b.x);
    };
    double      best   = 0.9 * cost(first, last);
    std::size_t cut    = 0;
    bool        column = false;
    for (const bool along_x : {true, false})
      {
        along_x ? std::sort(first, last, by_column) : std::sort(first, last, by_row);
        std::ptrdiff_t filled = first->x;
        for (auto run = first; run != last; ++run)
          {
            const bool may_cut = run != first &&
                                 (along_x ? run->x >= filled : run->y > (run - 1)->y);
            filled = std::max(filled, run->x + static_cast<std::ptrdiff_t>(run->n));
            if (!may_cut)
              continue;
            const double found = cost(first, run) + cost(run, last);
            if (found < best)
              {
                best   = found;
                cut    = run - first;
                column = along_x;
              }
          }
      }
    if (cut == 0)
      {
        clusters.push_back(end);
        return;
      }
    if (column)
      std::sort(first, last, by_column);
    find_clusters(begin, begin + cut);
    find_clusters(begin + cut, end);
  }


  template <int dim>
  void LatticeStretches<dim>::apply(const StencilKernel::Term *terms,
                                    const std::size_t          n_terms,
                                    const std::size_t          group,
                                    double                    *to) const
  {
    const std::size_t begin = group == 0 ? 0 : layout.groups[group - 1].runs,
                      end   = layout.groups[group].runs;
    for (std::size_t k = begin; k < end; ++k)
      runs[k].out = to + places[k];
    StencilKernel::apply_sum(terms, n_terms, runs.data() + begin, end - begin);
  }


  template <int dim>
  void LatticeStretches<dim>::apply_to_cluster(const StencilKernel::Term *terms,
                                               const std::size_t          n_terms,
                                               const std::size_t          cluster,
                                               double                    *to) const
  {
    const std::size_t begin = cluster == 0 ? 0 : clusters[cluster - 1], end = clusters[cluster];
    for (std::size_t k = begin; k < end; ++k)
      edge_runs[k].out = to + edge_places[k];
    StencilKernel::apply_sum(terms, n_terms, edge_runs.data() + begin, end - begin);
  }


  template <int dim>
  std::size_t LatticeStretches<dim>::memory_consumption() const
  {
    return groups.capacity() * sizeof(Group) + list.capacity() * sizeof(Stretch) +
           (places.capacity() + edge_places.capacity()) * sizeof(std::uint32_t) +
           clusters.capacity() * sizeof(std::size_t) +
           (runs.capacity() + edge_runs.capacity()) * sizeof(StencilKernel::Run);
  }


  PERIDEAL_INSTANTIATE_CLASS(class LatticeStretches);
} // namespace PeriDeal
