// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <cstddef>
#include <cstdint>

namespace PeriDeal
{
  /**
   * A sum of 64 bits over all bytes that are added, in whatever pieces, and over their number. A
   * change within one word of eight bytes always changes it, any other does but once in 2^64.
   */
  class Checksum
  {
  public:
    void          add(const void *bytes, const std::size_t n);
    std::uint64_t value() const;

  private:
    static constexpr std::size_t n_lanes = 4, n_block = 8 * n_lanes;

    void take_block(const unsigned char *block);

    std::uint64_t lanes[n_lanes] = {1, 2, 3, 4};
    std::uint64_t n_bytes        = 0;
    unsigned char waiting[n_block]; // bytes of a block that is not yet whole
  };


  /** The sum of one piece. */
  std::uint64_t checksum(const void *bytes, const std::size_t n);
} // namespace PeriDeal
