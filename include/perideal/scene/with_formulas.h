// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/mpi.h>

#include <functional>

namespace PeriDeal
{
  /**
   * Do what asks formulas for values: those that are none there become everybody's UserError when
   * it has been done, so that no process waits for another that has thrown. Not within itself.
   * Collective.
   */
  void with_formulas(const MPI_Comm communicator, const std::function<void()> &action);
} // namespace PeriDeal
