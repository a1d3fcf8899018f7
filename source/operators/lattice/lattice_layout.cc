// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "lattice_layout.h"

#include <perideal/base/instantiate.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  LatticeLayout<dim>::LatticeLayout(const Families<dim>      &families,
                                    const std::array<int, 3> &halo,
                                    const std::vector<bool>  &computed)
    : halo(halo)
  {
    lay_out_grid(families);
    find_fills(families);
    find_runs(families, computed);
    find_groups(families);
    order_fills();
  }


  template <int dim>
  std::size_t LatticeLayout<dim>::slot(const Index &site) const
  {
    std::size_t s = 0;
    for (unsigned int d = dim; d-- > 0;)
      s = s * extent[d] + (site[d] - corner[d]);
    return s;
  }


  template <int dim>
  std::array<std::ptrdiff_t, 3> LatticeLayout<dim>::place(std::size_t slot) const
  {
    std::array<std::ptrdiff_t, 3> p{{0, 0, 0}};
    for (unsigned int d = 0; d < dim; ++d)
      {
        p[d] = slot % extent[d];
        slot /= extent[d];
      }
    return p;
  }


  template <int dim>
  bool LatticeLayout<dim>::in_grid(const Index &site) const
  {
    for (unsigned int d = 0; d < dim; ++d)
      if (site[d] < corner[d] || site[d] >= corner[d] + extent[d])
        return false;
    return true;
  }


  template <int dim>
  std::size_t LatticeLayout<dim>::n_slots() const
  {
    std::size_t n = 1;
    for (unsigned int d = 0; d < dim; ++d)
      n *= extent[d];
    return n;
  }


  template <int dim>
  StencilKernel::Grid LatticeLayout<dim>::grid(const double *data) const
  {
    StencilKernel::Grid padded;
    padded.data = data;
    if constexpr (dim > 1)
      padded.row_stride = extent[0];
    if constexpr (dim > 2)
      padded.plane_stride = static_cast<std::ptrdiff_t>(extent[0]) * extent[1];
    return padded;
  }


  template <int dim>
  void LatticeLayout<dim>::lay_out_grid(const Families<dim> &families)
  {
    const Nodes<dim> &nodes = families.nodes();
    Index             low{}, high{};
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        const Index site = nodes.lattice()->index(nodes.position(i));
        for (unsigned int d = 0; d < dim; ++d)
          {
            low[d]  = i == 0 ? site[d] : std::min(low[d], site[d]);
            high[d] = i == 0 ? site[d] : std::max(high[d], site[d]);
          }
      }
    for (unsigned int d = 0; d < dim; ++d)
      {
        corner[d] = low[d] - halo[d];
        extent[d] = high[d] + halo[d] + 1 - corner[d];
      }
  }


  template <int dim>
  void LatticeLayout<dim>::find_fills(const Families<dim> &families)
  {
    constexpr std::uint32_t longest = dim == 1 ? 8192 : LatticePiece::none;
    const Nodes<dim>       &nodes   = families.nodes();
    std::size_t             next    = 0;
    for (unsigned int i = 0; i < nodes.n_local(); ++i)
      {
        const Index site = nodes.lattice()->index(nodes.position(i));
        if (!in_grid(site))
          continue;
        const std::size_t s         = slot(site);
        const bool        continues = !fills.empty() && s == next && i != nodes.n_owned() &&
                               fills.back().node + fills.back().n == i && s % extent[0] != 0 &&
                               fills.back().n < longest;
        if (continues)
          ++fills.back().n;
        else
          {
            LatticePiece piece;
            piece.slot = s;
            piece.node = i;
            piece.n    = 1;
            fills.push_back(piece);
          }
        next = s + 1;
      }
  }


  template <int dim>
  void LatticeLayout<dim>::find_runs(const Families<dim>     &families,
                                     const std::vector<bool> &computed)
  {
    for (const LatticePiece &piece : fills)
      if (piece.node < families.nodes().n_owned())
        for (std::uint32_t begin = 0, end = 0; begin < piece.n; begin = end + 1)
          {
            for (end = begin; end < piece.n && (computed.empty() || computed[piece.node + end]);
                 ++end)
              {}
            if (end == begin)
              continue;
            const auto p = place(piece.slot + begin);
            runs.push_back({p[0], p[1], p[2], end - begin, nullptr});
          }
    StencilKernel::sort_for_reuse(runs);
  }


  template <int dim>
  void LatticeLayout<dim>::find_groups(const Families<dim> &families)
  {
    for (std::size_t k = 0; k < runs.size(); ++k)
      {
        const StencilKernel::Run           &run = runs[k];
        const std::array<std::ptrdiff_t, 3> p{{run.x, run.y, run.z}};
        Index                               site;
        for (unsigned int d = 0; d < dim; ++d)
          site[d] = corner[d] + static_cast<int>(p[d]);
        LatticePiece piece;
        piece.slot = slot(site);
        piece.node = families.neighbors().node_at(site);
        piece.n    = static_cast<std::uint32_t>(run.n);
        pieces.push_back(piece);
        first_nodes.push_back(piece.node);

        constexpr std::ptrdiff_t block   = StencilKernel::block_rows;
        const bool               goes_on = dim > 1 && k > 0 && run.z == runs[k - 1].z &&
                             run.y / block == runs[k - 1].y / block;
        if (!goes_on)
          groups.emplace_back();
        if (goes_on && ranges.back().second == piece.node)
          ranges.back().second += piece.n;
        else
          ranges.emplace_back(piece.node, piece.node + piece.n);
        groups.back().runs   = k + 1;
        groups.back().pieces = k + 1;
        groups.back().ranges = ranges.size();
      }
  }


  /**
   * Put pieces to be filled in the order in which groups first need them; leave out those that none
   * needs.
   */
  template <int dim>
  void LatticeLayout<dim>::order_fills()
  {
    const auto row_of = [&](const LatticePiece &piece) { return piece.slot / extent[0]; };
    std::stable_sort(fills.begin(), fills.end(), [&](const auto &a, const auto &b) {
      return row_of(a) < row_of(b);
    });
    const std::size_t        n_rows = n_slots() / extent[0], n_y = dim > 1 ? extent[dim > 1] : 1;
    std::vector<std::size_t> starts(n_rows + 1, 0);
    for (const LatticePiece &piece : fills)
      ++starts[row_of(piece) + 1];
    for (std::size_t r = 0; r < n_rows; ++r)
      starts[r + 1] += starts[r];

    std::vector<bool>         done(fills.size(), false);
    std::vector<LatticePiece> ordered;
    std::size_t               k = 0;
    for (Group &group : groups)
      {
        const std::ptrdiff_t z = runs[k].z;
        std::ptrdiff_t x_begin = runs[k].x, x_end = x_begin, y_begin = runs[k].y, y_end = y_begin;
        for (; k < group.runs; ++k)
          {
            x_begin = std::min(x_begin, runs[k].x);
            x_end   = std::max(x_end, runs[k].x + static_cast<std::ptrdiff_t>(runs[k].n));
            y_begin = std::min(y_begin, runs[k].y);
            y_end   = std::max(y_end, runs[k].y + 1);
          }
        for (std::ptrdiff_t c = z - halo[2]; c <= z + halo[2]; ++c)
          for (std::ptrdiff_t b = y_begin - halo[1]; b < y_end + halo[1]; ++b)
            for (std::size_t f = starts[b + n_y * c]; f < starts[b + n_y * c + 1]; ++f)
              {
                const std::ptrdiff_t x = fills[f].slot % extent[0];
                if (done[f] || x >= x_end + halo[0] || x + fills[f].n <= x_begin - halo[0])
                  continue;
                done[f] = true;
                ordered.push_back(fills[f]);
              }
        group.fills = ordered.size();
      }
    fills.swap(ordered);
  }


  template <int dim>
  void LatticeLayout<dim>::cut(const LatticePiece        &piece,
                               const std::vector<double> &volumes,
                               const std::vector<double> *family_sums,
                               std::vector<LatticePiece> &list)
  {
    const auto same = [&](const std::uint32_t i, const std::uint32_t j) {
      return volumes[i] == volumes[j] &&
             (family_sums == nullptr || (*family_sums)[i] == (*family_sums)[j]);
    };
    // The longest stretch of constant values, if it is worth a piece.
    std::uint32_t begin = 0, end = 0;
    for (std::uint32_t first = 0, k = 1; k <= piece.n; ++k)
      if (k == piece.n || !same(piece.node + first, piece.node + k))
        {
          if (k - first > end - begin)
            {
              begin = first;
              end   = k;
            }
          first = k;
        }
    constexpr std::uint32_t least = 16;
    if (end - begin < least && end - begin < piece.n)
      begin = end = 0;
    const std::uint32_t limits[4] = {0, begin, end, piece.n};
    for (unsigned int part = 0; part < 3; ++part)
      {
        if (limits[part] == limits[part + 1])
          continue;
        LatticePiece next = piece;
        next.slot += limits[part];
        next.node += limits[part];
        next.n = limits[part + 1] - limits[part];
        if (part == 1)
          {
            next.volume     = volumes[next.node];
            next.family_sum = family_sums != nullptr ? (*family_sums)[next.node] : 0.;
          }
        else
          {
            next.varying = static_cast<std::uint32_t>(varying_volumes.size());
            for (std::uint32_t k = 0; k < next.n; ++k)
              {
                varying_volumes.push_back(volumes[next.node + k]);
                varying_sums.push_back(family_sums != nullptr ? (*family_sums)[next.node + k] : 0.);
              }
          }
        list.push_back(next);
      }
  }


  template <int dim>
  void LatticeLayout<dim>::set_values(const std::vector<double> &volumes,
                                      const std::vector<double> &family_sums)
  {
    std::vector<LatticePiece> new_fills, new_pieces;
    std::size_t               f = 0, p = 0;
    for (Group &group : groups)
      {
        for (; f < group.fills; ++f)
          cut(fills[f], volumes, nullptr, new_fills);
        for (; p < group.pieces; ++p)
          cut(pieces[p], volumes, &family_sums, new_pieces);
        group.fills  = new_fills.size();
        group.pieces = new_pieces.size();
      }
    new_fills.shrink_to_fit();
    new_pieces.shrink_to_fit();
    fills.swap(new_fills);
    pieces.swap(new_pieces);
  }


  template <int dim>
  std::size_t LatticeLayout<dim>::memory_consumption() const
  {
    return groups.capacity() * sizeof(Group) +
           (fills.capacity() + pieces.capacity()) * sizeof(LatticePiece) +
           runs.capacity() * sizeof(StencilKernel::Run) +
           first_nodes.capacity() * sizeof(std::uint32_t) + ranges.capacity() * sizeof(ranges[0]) +
           (varying_volumes.capacity() + varying_sums.capacity()) * sizeof(double);
  }

  PERIDEAL_INSTANTIATE_CLASS(class LatticeLayout);
} // namespace PeriDeal
