// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <mpi.h>

#include <string>

namespace PeriDeal
{
  /**
   * Bytes that programs on this machine can still take: what the system has available, or what the
   * groups of processes that this one is in (cgroups, as containers have) are allowed in addition,
   * whichever is less. Infinity where the system does not tell.
   *
   * @param root where /proc and /sys are, for tests. Not collective.
   */
  double available_memory(const std::string &root = "");

  /**
   * What all processes together can take if each takes the same: their number times the smallest
   * share of a machine that one of them has, its own limit (ulimit -v) included. What they have
   * already counts as taken. Collective.
   */
  double available_memory(const MPI_Comm communicator);

  /** Bytes of memory that this process has, and the most that it has had since
   * forget_peak_memory(), or ever. 0 where the system does not tell. */
  double resident_memory();
  double peak_memory();

  /** Give free memory back and begin to look for the peak anew. Returns whether the system can. */
  bool forget_peak_memory();
} // namespace PeriDeal
