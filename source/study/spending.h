// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/control.h>

#include <mpi.h>

#include <chrono>
#include <string>

namespace PeriDeal
{
  /** What `Budget` and `Memory` leave, from its construction on. All functions are collective. */
  class Spending
  {
  public:
    Spending(const AccuracyControl &accuracy, const MPI_Comm communicator);

    double elapsed() const; // seconds

    /** Whether so many seconds leave half of the budget. */
    bool may_take(const double seconds) const;

    /** Whether so many seconds and bytes may still be spent: what forbids it, or nothing. */
    std::string limit_of(const double seconds, const double bytes) const;

  private:
    const AccuracyControl                      &accuracy;
    MPI_Comm                                    communicator;
    const std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
  };
} // namespace PeriDeal
