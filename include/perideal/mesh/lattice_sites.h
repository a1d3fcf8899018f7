// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <array>
#include <cstddef>

namespace PeriDeal
{
  // Sites of a lattice as numbers along each direction.

  template <std::size_t dim>
  std::array<int, dim> operator+(std::array<int, dim> a, const std::array<int, dim> &b)
  {
    for (unsigned int d = 0; d < dim; ++d)
      a[d] += b[d];
    return a;
  }


  /** Call visit(site) for all sites of a box, the first coordinate fastest. */
  template <std::size_t dim, typename Visit>
  void for_each_site(const std::array<int, dim> &first,
                     const std::array<int, dim> &last,
                     const Visit                &visit)
  {
    for (unsigned int d = 0; d < dim; ++d)
      if (last[d] < first[d])
        return;
    for (auto site = first;;)
      {
        visit(site);
        unsigned int d = 0;
        for (; d < dim && site[d] == last[d]; ++d)
          site[d] = first[d];
        if (d == dim)
          return;
        ++site[d];
      }
  }
} // namespace PeriDeal
