// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "checksum.h"

#include <algorithm>
#include <cstring>

namespace PeriDeal
{
  namespace
  {
    /** For each of its arguments one-to-one in the other. */
    std::uint64_t stirred(const std::uint64_t sum, const std::uint64_t word)
    {
      const std::uint64_t x = (sum ^ word) * 0x9e3779b97f4a7c15u;
      return x ^ (x >> 29);
    }
  } // namespace


  void Checksum::take_block(const unsigned char *block)
  {
    for (std::size_t k = 0; k < n_lanes; ++k)
      {
        std::uint64_t word;
        std::memcpy(&word, block + 8 * k, 8);
        lanes[k] = stirred(lanes[k], word);
      }
  }


  void Checksum::add(const void *bytes, const std::size_t n)
  {
    const unsigned char *next = static_cast<const unsigned char *>(bytes), *const end = next + n;
    std::size_t n_waiting = n_bytes % n_block;
    n_bytes += n;
    if (n_waiting > 0)
      {
        const std::size_t n_more = std::min(n, n_block - n_waiting);
        std::copy(next, next + n_more, waiting + n_waiting);
        next += n_more;
        n_waiting += n_more;
        if (n_waiting < n_block)
          return;
        take_block(waiting);
      }
    for (; static_cast<std::size_t>(end - next) >= n_block; next += n_block)
      take_block(next);
    std::copy(next, end, waiting);
  }


  std::uint64_t Checksum::value() const
  {
    Checksum          last      = *this;
    const std::size_t n_waiting = n_bytes % n_block;
    std::fill(last.waiting + n_waiting, last.waiting + n_block, 0);
    last.take_block(last.waiting);
    std::uint64_t sum = n_bytes;
    for (const std::uint64_t lane : last.lanes)
      sum = stirred(sum, lane);
    return sum;
  }


  std::uint64_t checksum(const void *bytes, const std::size_t n)
  {
    Checksum sum;
    sum.add(bytes, n);
    return sum.value();
  }
} // namespace PeriDeal
