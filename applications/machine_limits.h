// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <memory>
#include <string>

namespace PeriDeal
{
  /**
   * What one core of this machine can do, measured with the instruction set that the stencil kernel
   * uses.
   */
  struct MachineLimits
  {
    std::string target;     // name of the instruction set
    double      fma   = 0.; // fused multiply-adds of doubles per second, all operands in registers
    double      loads = 0.; // doubles per second from the first cache, aligned
    double      unaligned = 0.; // the same, each vector one double off
    double      triad =
      0.; // STREAM triad a = b + s c on arrays beyond all caches, bytes per second (24 an entry)
  };

  /** The STREAM triad a = b + s c on arrays beyond all caches. */
  class Triad
  {
  public:
    Triad();
    ~Triad();

    /** Bytes per second of one pass, 24 an entry; takes some 10 ms. */
    double rate();

  private:
    struct Arrays;
    std::unique_ptr<Arrays> arrays;
  };

  /**
   * Takes about a second. Each number is the best of several trials, and of the limits of an
   * earlier call.
   */
  void measure_machine(MachineLimits &limits);
} // namespace PeriDeal
