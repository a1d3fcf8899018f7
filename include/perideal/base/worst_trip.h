// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/diverged.h>

#include <mpi.h>

namespace PeriDeal
{
  /**
   * Keep in @p worst the lower of two values, no number being the lowest; of those that are equal
   * to round-off the one whose place comes first, so that any number of processes finds the same.
   */
  void keep_lower(Trip &worst, const Trip &found);

  /**
   * Each process passes the lowest that it has found, or nothing. If any has found one, every
   * process throws Diverged with the lowest of all, its sentence being the message. Collective.
   */
  void throw_lowest_if_any(const MPI_Comm communicator, const Trip &own);
} // namespace PeriDeal
