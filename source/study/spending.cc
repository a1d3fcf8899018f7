// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "spending.h"

#include <deal.II/base/mpi.h>

#include <perideal/base/memory.h>
#include <perideal/simulation/estimate.h>

namespace PeriDeal
{
  using namespace dealii;

  Spending::Spending(const AccuracyControl &accuracy, const MPI_Comm communicator)
    : accuracy(accuracy)
    , communicator(communicator)
  {}


  double Spending::elapsed() const
  {
    const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return Utilities::MPI::max(seconds, communicator);
  }


  bool Spending::may_take(const double seconds) const
  {
    return accuracy.budget <= 0. || elapsed() + seconds < 0.5 * accuracy.budget;
  }


  std::string Spending::limit_of(const double seconds, const double bytes) const
  {
    if (accuracy.budget > 0. && elapsed() + seconds > accuracy.budget)
      return "'Budget'";
    const double taken = Utilities::MPI::sum(resident_memory(), communicator);
    const bool   given = accuracy.memory > 0.;
    const double left  = given ? accuracy.memory - taken : available_memory(communicator);
    return bytes < left ? "" : given ? "'Memory'" : "the memory of the machine";
  }
} // namespace PeriDeal
