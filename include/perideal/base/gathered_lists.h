// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <mpi.h>

#include <vector>

namespace PeriDeal
{
  /**
   * The lists of all processes, by rank. deal.II's all_gather() packs and compresses them, which
   * takes longer than to send numbers as they are. Collective.
   */
  std::vector<std::vector<double>> gathered_lists(const MPI_Comm             communicator,
                                                  const std::vector<double> &own);
} // namespace PeriDeal
