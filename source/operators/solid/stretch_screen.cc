// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/base/symmetric_tensor.h>

#include <perideal/base/instantiate.h>
#include <perideal/mesh/lattice_sites.h>
#include <perideal/operators/solid/stretch_screen.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "edge_ranges.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    constexpr double never = std::numeric_limits<double>::infinity();
    constexpr double slack = 1e-9; // of a bound; more than its round-off


    template <int dim>
    double largest_eigenvalue(const SymmetricTensor<2, dim> &a, const double enough)
    {
      double rows = -never; // Gershgorin
      for (unsigned int d = 0; d < dim; ++d)
        {
          double row = a[d][d];
          for (unsigned int e = 0; e < dim; ++e)
            row += e == d ? 0. : std::abs(a[d][e]);
          rows = std::max(rows, row);
        }
      return rows < enough || dim == 1 ? rows : std::min(rows, eigenvalues(a)[0]);
    }
  } // namespace


  template <int dim>
  StretchScreen<dim>::StretchScreen(const Families<dim>       &families,
                                    const std::vector<double> &critical)
    : families(families)
    , critical(critical)
    , least(never)
  {
    const NodeSearch<dim> &search  = *families.nodes().search();
    const Lattice<dim>    &lattice = *families.nodes().lattice();
    Index                  sites{};
    for (const FamilyMember<dim> &member : families.weights().members())
      {
        Member     next;
        const auto at = [&](const Index &index) {
          return static_cast<std::ptrdiff_t>(search.key(index));
        };
        Index origin{};
        if (families.nodes().n_owned() > 0)
          origin = lattice.index(families.nodes().position(0));
        next.key = at(origin + member.offset) - at(origin);
        for (unsigned int d = 0; d < dim; ++d)
          {
            next.xi[d] = member.offset[d] * lattice.spacing[d];
            sites[d]   = std::max(sites[d], std::abs(member.offset[d]));
          }
        next.square = next.xi.norm_square();
        members.push_back(next);
      }
    for (unsigned int d = 0; d < dim; ++d)
      reach[d] = (sites[d] + width - 1) / width;
    lay_out_blocks();
    find_runs();
    find_limits();
    find_irregular();
    sums.resize(2 * n_all * dim * width);
    for (unsigned int s = 0; s < n_slopes; ++s)
      {
        low[s].resize(n_all);
        high[s].resize(n_all);
      }
    spare.resize(n_all);
    bounds.resize(n_all);
    found.reserve(families.nodes().n_owned());
  }


  template <int dim>
  void StretchScreen<dim>::lay_out_blocks()
  {
    const Nodes<dim> &nodes = families.nodes();
    Index             last{};
    corner = Index{};
    for (unsigned int i = 0; i < nodes.n_local(); ++i)
      {
        const Index site = nodes.lattice()->index(nodes.position(i));
        for (unsigned int d = 0; d < dim; ++d)
          {
            corner[d] = i == 0 ? site[d] : std::min(corner[d], site[d]);
            last[d]   = i == 0 ? site[d] : std::max(last[d], site[d]);
          }
      }
    n_all = 1;
    for (unsigned int d = 0; d < dim; ++d)
      {
        n_blocks[d] = (last[d] - corner[d]) / width + 1;
        strides[d]  = static_cast<std::ptrdiff_t>(n_all);
        n_all *= n_blocks[d];
      }
  }


  template <int dim>
  typename StretchScreen<dim>::Index StretchScreen<dim>::block_index(const Index &site) const
  {
    Index index;
    for (unsigned int d = 0; d < dim; ++d)
      index[d] = (site[d] - corner[d]) / width;
    return index;
  }


  template <int dim>
  std::size_t StretchScreen<dim>::block_number(const Index &index) const
  {
    std::size_t number = 0;
    for (unsigned int d = 0; d < dim; ++d)
      number += index[d] * strides[d];
    return number;
  }


  template <int dim>
  void StretchScreen<dim>::find_runs()
  {
    const Nodes<dim> &nodes = families.nodes();
    Index             last{};
    const auto        add = [&](std::vector<Run>  &list,
                         const unsigned int i,
                         const unsigned int other,
                         const Index       &site,
                         const bool         beside) {
      if (beside && !list.empty() && list.back().node + list.back().n == i &&
          list.back().other + list.back().n == other)
        ++list.back().n;
      else
        list.push_back({i,
                        other,
                        1,
                        static_cast<unsigned int>(block_number(block_index(site))),
                        static_cast<unsigned int>((site[0] - corner[0]) % width)});
    };
    for (unsigned int i = 0; i < nodes.n_local(); ++i)
      {
        const Index site   = nodes.lattice()->index(nodes.position(i));
        bool        beside = i > 0 && site[0] == last[0] + 1 && i != nodes.n_owned();
        for (unsigned int d = 1; d < dim; ++d)
          beside = beside && site[d] == last[d];
        last = site;
        if (i < nodes.n_owned())
          add(rows, i, i, site, beside);
        for (unsigned int d = 0; d < dim; ++d)
          {
            Index next = site;
            ++next[d];
            const unsigned int other = families.neighbors().node_at(next);
            if (other != numbers::invalid_unsigned_int)
              add(edges[d], i, other, site, beside);
          }
      }
    for (std::vector<Run> &list : edges)
      list.shrink_to_fit();
  }


  template <int dim>
  template <typename Visit>
  void StretchScreen<dim>::for_each_around(const Index &index, const Visit &visit) const
  {
    Index first, last;
    for (unsigned int d = 0; d < dim; ++d)
      {
        first[d] = std::max(0, index[d] - reach[d]);
        last[d]  = std::min(n_blocks[d] - 1, index[d] + reach[d]);
      }
    for_each_site(first, last, [&](const Index &other) { visit(block_number(other)); });
  }


  template <int dim>
  void StretchScreen<dim>::find_limits()
  {
    const Nodes<dim>   &nodes = families.nodes();
    std::vector<double> own(n_all, never);
    limits.assign(n_all, never);
    least = critical.empty() ? never : *std::min_element(critical.begin(), critical.end());
    for (unsigned int i = 0; i < nodes.n_local(); ++i)
      {
        double &lowest = own[block_number(block_index(nodes.lattice()->index(nodes.position(i))))];
        lowest         = std::min(lowest, critical[i]);
      }
    Index first{}, last;
    for (unsigned int d = 0; d < dim; ++d)
      last[d] = n_blocks[d] - 1;
    for_each_site(first, last, [&](const Index &index) {
      double &limit = limits[block_number(index)];
      for_each_around(index, [&](const std::size_t other) { limit = std::min(limit, own[other]); });
    });
  }


  template <int dim>
  bool StretchScreen<dim>::is_irregular(const unsigned int i,
                                        const Index       &low_end,
                                        const Index       &high_end) const
  {
    const Index site = families.nodes().lattice()->index(families.nodes().position(i));
    for (const FamilyMember<dim> &member : families.weights().members())
      {
        const Index other  = site + member.offset;
        bool        within = true;
        for (unsigned int d = 0; d < dim; ++d)
          within = within && other[d] >= low_end[d] && other[d] <= high_end[d];
        if (within && families.neighbors().node_at(other) == numbers::invalid_unsigned_int)
          return true;
      }
    return false;
  }


  template <int dim>
  void StretchScreen<dim>::find_irregular()
  {
    const Nodes<dim> &nodes = families.nodes();
    // How far out the body is, on all processes.
    std::vector<int>         ends(2 * dim, std::numeric_limits<int>::min() / 2);
    std::vector<std::size_t> n_nodes(n_all, 0);
    for (unsigned int i = 0; i < nodes.n_local(); ++i)
      {
        const Index site = nodes.lattice()->index(nodes.position(i));
        ++n_nodes[block_number(block_index(site))];
        for (unsigned int d = 0; d < dim && i < nodes.n_owned(); ++d)
          {
            ends[2 * d]     = std::max(ends[2 * d], -site[d]);
            ends[2 * d + 1] = std::max(ends[2 * d + 1], site[d]);
          }
      }
    std::vector<int> all(ends);
    Utilities::MPI::max(ends, nodes.communicator(), all);
    Index low_end, high_end;
    for (unsigned int d = 0; d < dim; ++d)
      {
        low_end[d]  = -all[2 * d];
        high_end[d] = all[2 * d + 1];
      }
    std::size_t n_full = 1;
    for (unsigned int d = 0; d < dim; ++d)
      n_full *= width;
    always.assign(n_all, false);
    for (unsigned int i = 0; i < nodes.n_owned(); ++i)
      {
        const Index       index = block_index(nodes.lattice()->index(nodes.position(i)));
        const std::size_t block = block_number(index);
        if (always[block])
          continue;
        bool full = true; // all blocks around
        for (unsigned int d = 0; d < dim; ++d)
          full = full && index[d] >= reach[d] && index[d] + reach[d] < n_blocks[d];
        if (full)
          for_each_around(index, [&](const std::size_t other) {
            full = full && n_nodes[other] == n_full;
          });
        always[block] = !full && is_irregular(i, low_end, high_end);
      }
  }


  template <int dim>
  template <typename Visit>
  void StretchScreen<dim>::for_each_chunk(const Run &run, const Visit &visit) const
  {
    // Parts that lie in one block each.
    unsigned int block = run.block, shift = run.shift;
    for (unsigned int k = 0; k < run.n; shift = 0, ++block)
      {
        const unsigned int n = std::min<unsigned int>(width - shift, run.n - k);
        visit(k, n, block, shift);
        k += n;
      }
  }


  template <int dim>
  void StretchScreen<dim>::find_slopes(const double *u) const
  {
    constexpr unsigned int n_row = dim * width; // numbers of a row of a block
    for (unsigned int d = 0; d < dim; ++d)
      {
        for (std::size_t block = 0; block < n_all; ++block)
          {
            double *const own = sums.data() + 2 * n_row * block;
            std::fill(own, own + n_row, never);
            std::fill(own + n_row, own + 2 * n_row, -never);
          }
        for (const Run &run : edges[d])
          {
            const double *const from = u + static_cast<std::size_t>(dim) * run.node,
                                *to  = u + static_cast<std::size_t>(dim) * run.other;
            const unsigned int head =
              std::min<unsigned int>(run.n, run.shift == 0 ? 0 : width - run.shift);
            double *own = sums.data() + 2 * n_row * static_cast<std::size_t>(run.block);
            extend_ranges(from, to, dim * head, own + dim * run.shift, n_row);
            own += head > 0 ? 2 * n_row : 0;
            const unsigned int n_whole = (run.n - head) / width, done = head + n_whole * width;
            extend_row_ranges(from + dim * head, to + dim * head, n_whole, n_row, own);
            extend_ranges(from + dim * done,
                          to + dim * done,
                          dim * (run.n - done),
                          own + 2 * n_row * static_cast<std::size_t>(n_whole),
                          n_row);
          }
        const double scale = 1. / families.nodes().lattice()->spacing[d];
        for (unsigned int c = 0; c < dim; ++c)
          for (std::size_t block = 0; block < n_all; ++block)
            {
              const double *const own   = sums.data() + 2 * n_row * block + c;
              double              least = own[0], most = own[n_row];
              for (unsigned int k = 1; k < width; ++k)
                {
                  least = std::min(least, own[dim * k]);
                  most  = std::max(most, own[n_row + dim * k]);
                }
              low[dim * d + c][block]  = scale * least;
              high[dim * d + c][block] = scale * most;
            }
      }
  }


  template <int dim>
  void StretchScreen<dim>::spread() const
  {
    const auto spread_along =
      [&](const unsigned int d, std::vector<double> &values, const auto &join) {
        std::copy(values.begin(), values.end(), spare.begin());
        const std::size_t n = n_blocks[d], stride = strides[d];
        for (int shift = 1; shift <= reach[d]; ++shift)
          for (std::size_t begin = 0; begin < n_all; begin += n * stride)
            {
              if (static_cast<std::size_t>(shift) >= n)
                continue;
              const std::size_t n_pairs = (n - shift) * stride, by = shift * stride;
              double *const     to   = values.data() + begin;
              const double     *from = spare.data() + begin;
              for (std::size_t k = 0; k < n_pairs; ++k)
                to[k] = join(to[k], from[k + by]);
              for (std::size_t k = 0; k < n_pairs; ++k)
                to[k + by] = join(to[k + by], from[k]);
            }
      };
    for (unsigned int s = 0; s < n_slopes; ++s)
      for (unsigned int d = 0; d < dim; ++d)
        {
          spread_along(d, low[s], [](const double a, const double b) { return b < a ? b : a; });
          spread_along(d, high[s], [](const double a, const double b) { return b > a ? b : a; });
        }
  }


  template <int dim>
  double StretchScreen<dim>::bound_of_block(const std::size_t block) const
  {
    SymmetricTensor<2, dim> mean, half;
    double                  round_off = 0.;
    for (unsigned int d = 0; d < dim; ++d)
      for (unsigned int c = 0; c < dim; ++c)
        {
          const double a = low[dim * d + c][block], b = high[dim * d + c][block];
          if (!(a <= b)) // no edge along d, and so no bond along it
            continue;
          const double share = c == d ? 0.5 : 0.25; // half of the symmetric part
          mean[c][d] += share * (a + b);
          half[c][d] += share * (b - a);
          round_off += 1e-12 * (std::abs(a) + std::abs(b));
        }
    const double of_half = largest_eigenvalue(half, 0.) + round_off;
    return of_half + largest_eigenvalue(mean, limits[block] - of_half);
  }


  template <int dim>
  const std::vector<unsigned int> &StretchScreen<dim>::suspects(const double *u,
                                                                const double  least_strain) const
  {
    find_slopes(u);
    spread();
    found.clear();
    for (std::size_t block = 0; block < n_all; ++block)
      bounds[block] = always[block]          ? never :
                      limits[block] == never ? -never :
                                               bound_of_block(block);
    for (const Run &run : rows)
      for_each_chunk(
        run,
        [&](const unsigned int k, const unsigned int n, const unsigned int block, unsigned int) {
          if (!(bounds[block] * (1. + slack) - least_strain < limits[block] * (1. - slack)))
            for (unsigned int m = k; m < k + n; ++m)
              found.push_back(run.node + m);
        });
    return found;
  }


  template <int dim>
  double StretchScreen<dim>::bound(const unsigned int node) const
  {
    return bounds[block_number(
      block_index(families.nodes().lattice()->index(families.nodes().position(node))))];
  }


  template <int dim>
  bool StretchScreen<dim>::may_reach(const unsigned int node,
                                     const double      *u,
                                     const double       least_strain) const
  {
    const Nodes<dim>      &nodes  = families.nodes();
    const NodeSearch<dim> &search = *nodes.search();
    const std::size_t      key    = search.key(nodes.lattice()->index(nodes.position(node)));
    const double *const    own    = u + static_cast<std::size_t>(dim) * node;
    const double           limit  = critical[node];
    for (const Member &member : members)
      {
        const unsigned int j = search[key + member.key];
        if (j == numbers::invalid_unsigned_int)
          continue;
        const double *const other   = u + static_cast<std::size_t>(dim) * j;
        double              product = 0., sizes = 0.;
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double term = member.xi[d] * (other[d] - own[d]);
            product += term;
            sizes += std::abs(term);
          }
        const double least =
          (std::min(limit, critical[j]) * (1. - slack) + least_strain) * member.square;
        if (!(product + 1e-12 * sizes < least))
          return true;
      }
    return false;
  }


  template <int dim>
  std::size_t StretchScreen<dim>::memory_consumption() const
  {
    std::size_t bytes =
      members.capacity() * sizeof(Member) + rows.capacity() * sizeof(Run) +
      found.capacity() * sizeof(unsigned int) +
      (sums.capacity() + spare.capacity() + bounds.capacity() + limits.capacity()) * sizeof(double);
    for (const std::vector<Run> &list : edges)
      bytes += list.capacity() * sizeof(Run);
    for (unsigned int s = 0; s < n_slopes; ++s)
      bytes += (low[s].capacity() + high[s].capacity()) * sizeof(double);
    return bytes;
  }


  PERIDEAL_INSTANTIATE_CLASS(class StretchScreen);
} // namespace PeriDeal
