// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace PeriDeal
{
  /** Sets of numbers that are connected; the root of a set is its lowest member. */
  class ConnectedSets
  {
  public:
    /** Each of 0 to n - 1 alone. */
    explicit ConnectedSets(const unsigned int n)
      : parent(n)
    {
      std::iota(parent.begin(), parent.end(), 0u);
    }

    unsigned int root(unsigned int i)
    {
      while (parent[i] != i)
        i = parent[i] = parent[parent[i]];
      return i;
    }

    void join(const unsigned int i, const unsigned int j)
    {
      const unsigned int a = root(i), b = root(j);
      parent[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<unsigned int> parent;
  };
} // namespace PeriDeal
