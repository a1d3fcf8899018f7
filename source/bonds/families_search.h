// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/families.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /** The nodes of this process and its halo, sorted into blocks of a regular grid, for families off the lattice. */
  template <int dim>
  struct Families<dim>::Search
  {
    /** @param radius that of searches to come. */
    Search(const Nodes<dim> &nodes, const double radius)
      : side(0.5 * radius)
    {
      if (nodes.n_local() == 0)
        return;
      dealii::Point<dim> high = low = nodes.position(0);
      for (unsigned int i = 1; i < nodes.n_local(); ++i)
        for (unsigned int d = 0; d < dim; ++d)
          {
            low[d]  = std::min(low[d], nodes.position(i)[d]);
            high[d] = std::max(high[d], nodes.position(i)[d]);
          }
      const double most_blocks = 1000. + 4. * nodes.n_local(); // also where the horizon is tiny
      for (;; side *= 2.)
        {
          double n_blocks = 1.;
          for (unsigned int d = 0; d < dim; ++d)
            n_blocks *= 1. + (high[d] - low[d]) / side;
          if (n_blocks <= most_blocks)
            break;
        }
      std::size_t n = 1;
      for (unsigned int d = 0; d < dim; ++d)
        {
          counts[d] = 1 + static_cast<int>((high[d] - low[d]) / side);
          n *= counts[d];
        }
      begins.assign(n + 1, 0);
      std::vector<std::size_t> blocks(nodes.n_local());
      for (unsigned int i = 0; i < nodes.n_local(); ++i)
        {
          for (unsigned int d = dim; d-- > 0;)
            blocks[i] = blocks[i] * counts[d] + block(nodes.position(i)[d], d);
          ++begins[blocks[i] + 1];
        }
      for (std::size_t b = 0; b < n; ++b)
        begins[b + 1] += begins[b];
      std::vector<unsigned int> next(begins.begin(), begins.end() - 1);
      entries.resize(nodes.n_local());
      for (unsigned int i = 0; i < nodes.n_local(); ++i)
        entries[next[blocks[i]]++] = {nodes.position(i), i};
    }

    /** Nodes within a radius of p, unordered, with squared distances. */
    void within(const dealii::Point<dim>                     &p,
                const double                                  radius,
                std::vector<std::pair<unsigned int, double>> &found) const
    {
      found.clear();
      std::array<int, dim> first{}, last{};
      for (unsigned int d = 0; d < dim && !entries.empty(); ++d)
        {
          first[d] = block(p[d] - radius, d);
          last[d]  = block(p[d] + radius, d);
        }
      const double square = radius * radius;
      for (auto at = first; !entries.empty();)
        {
          // Blocks that follow each other in the first direction are one range.
          std::size_t row = 0;
          for (unsigned int d = dim; d-- > 1;)
            row = (row + at[d]) * counts[d - 1];
          for (unsigned int k = begins[row + first[0]]; k < begins[row + last[0] + 1]; ++k)
            {
              double distance = 0.;
              for (unsigned int d = 0; d < dim; ++d)
                distance += (p[d] - entries[k].position[d]) * (p[d] - entries[k].position[d]);
              if (distance < square)
                found.emplace_back(entries[k].node, distance);
            }
          unsigned int d = 1;
          for (; d < dim && at[d] == last[d]; ++d)
            at[d] = first[d];
          if (d >= dim)
            break;
          ++at[d];
        }
    }

  private:
    struct Entry
    {
      dealii::Point<dim> position;
      unsigned int       node;
    };

    /** Of a coordinate, or the nearest one. */
    int block(const double x, const unsigned int d) const
    {
      return static_cast<int>(std::clamp((x - low[d]) / side, 0., counts[d] - 1.));
    }

    double                    side;
    dealii::Point<dim>        low;
    std::array<int, dim>      counts;
    std::vector<unsigned int> begins; // of blocks, in entries
    std::vector<Entry>        entries;
  };
} // namespace PeriDeal
