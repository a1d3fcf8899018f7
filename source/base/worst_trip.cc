// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/worst_trip.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    double value_of(const Trip &trip)
    {
      return std::isfinite(trip.value) ? trip.value : -std::numeric_limits<double>::infinity();
    }


    bool is_lower(const Trip &a, const Trip &b)
    {
      constexpr double same = 1e-12;
      const double     x = value_of(a), y = value_of(b);
      if (std::isinf(x) || std::isinf(y) ||
          std::abs(x - y) > same * std::max(std::abs(x), std::abs(y)))
        if (x != y)
          return x < y;
      return a.place < b.place;
    }
  } // namespace


  void keep_lower(Trip &worst, const Trip &found)
  {
    if (found && (!worst || is_lower(found, worst)))
      worst = found;
  }


  void throw_lowest_if_any(const MPI_Comm communicator, const Trip &own)
  {
    if (Utilities::MPI::max(own ? 1 : 0, communicator) == 0)
      return;
    const auto   values = Utilities::MPI::all_gather(communicator, own.value);
    const auto   places = Utilities::MPI::all_gather(communicator, own.place);
    const auto   any    = Utilities::MPI::all_gather(communicator, own ? 1 : 0);
    Trip         worst, found;
    unsigned int owner = 0;
    for (unsigned int rank = 0; rank < values.size(); ++rank)
      if (any[rank] != 0)
        {
          found.monitor = "found";
          found.value   = values[rank];
          found.place   = places[rank];
          if (worst && !is_lower(found, worst))
            continue;
          worst = found;
          owner = rank;
        }
    worst.monitor = Utilities::MPI::broadcast(communicator, own.monitor, owner);
    worst.found   = Utilities::MPI::broadcast(communicator, own.found, owner);
    worst.bound   = Utilities::MPI::broadcast(communicator, own.bound, owner);
    throw Diverged(worst.found, worst);
  }
} // namespace PeriDeal
