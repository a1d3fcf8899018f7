// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/gathered_lists.h>

namespace PeriDeal
{
  using namespace dealii;

  std::vector<std::vector<double>> gathered_lists(const MPI_Comm             communicator,
                                                  const std::vector<double> &own)
  {
    const unsigned int n_processes = Utilities::MPI::n_mpi_processes(communicator);
    if (n_processes == 1)
      return {own};
    const int        n = static_cast<int>(own.size());
    std::vector<int> sizes(n_processes), starts(n_processes, 0);
    MPI_Allgather(&n, 1, MPI_INT, sizes.data(), 1, MPI_INT, communicator);
    for (unsigned int rank = 1; rank < n_processes; ++rank)
      starts[rank] = starts[rank - 1] + sizes[rank - 1];
    std::vector<double> all(starts.back() + sizes.back());
    MPI_Allgatherv(own.data(),
                   n,
                   MPI_DOUBLE,
                   all.data(),
                   sizes.data(),
                   starts.data(),
                   MPI_DOUBLE,
                   communicator);
    std::vector<std::vector<double>> lists;
    for (unsigned int rank = 0; rank < n_processes; ++rank)
      lists.emplace_back(all.begin() + starts[rank], all.begin() + starts[rank] + sizes[rank]);
    return lists;
  }
} // namespace PeriDeal
