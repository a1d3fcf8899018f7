// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/diverged.h>
#include <perideal/base/user_error.h>

#include <mpi.h>

#include <limits>
#include <string>

namespace PeriDeal
{
  /**
   * Throw what a law has had wrong on any process: Diverged, of the monitor `law`, where all that
   * it asks for is a shorter step. Collective.
   *
   * @param text of this process; empty: nothing @param asks_for_less it is that
   */
  inline void throw_law_fault(const std::string &text,
                              const bool         asks_for_less,
                              const double       time,
                              const MPI_Comm     communicator)
  {
    const int own = text.empty() ? 0 : asks_for_less ? 1 : 2;
    int       all = 0;
    MPI_Allreduce(&own, &all, 1, MPI_INT, MPI_MAX, communicator);
    if (all == 0)
      return;
    try
      {
        throw_on_all_if_any(communicator, own == all ? text : "");
      }
    catch (const UserError &error)
      {
        constexpr double none = std::numeric_limits<double>::quiet_NaN();
        if (all == 2)
          throw;
        throw Diverged(error.message(), "law", none, none, time);
      }
  }
} // namespace PeriDeal
