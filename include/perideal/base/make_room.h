// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <cstddef>
#include <vector>

namespace PeriDeal
{
  /**
   * Room for more entries of a list that makes up much of the memory: an eighth beyond what is
   * wanted, where a list by itself would double.
   */
  template <typename T>
  void make_room(std::vector<T> &list, const std::size_t n_more)
  {
    const std::size_t n = list.size() + n_more;
    if (n > list.capacity())
      list.reserve(n + n / 8);
  }
} // namespace PeriDeal
