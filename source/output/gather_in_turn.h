// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace PeriDeal
{
  /**
   * Hand the numbers or bytes of each process to rank 0, one process after the other in their
   * order, so that it never holds those of two. @p use is called there with each. Container:
   * contiguous, of a type that may be copied byte by byte. Collective.
   */
  template <typename Container, typename Use>
  void gather_in_turn(const Container &own, const MPI_Comm communicator, const Use &use)
  {
    using Value                  = typename Container::value_type;
    constexpr int         tag    = 4711;
    constexpr std::size_t most   = std::size_t(1) << 28; // bytes of a message
    const unsigned int    rank   = dealii::Utilities::MPI::this_mpi_process(communicator);
    const unsigned int    n_proc = dealii::Utilities::MPI::n_mpi_processes(communicator);
    const auto in_parts = [most](auto *bytes, const std::uint64_t size, const auto &transfer) {
      for (std::uint64_t done = 0; done < size; done += most)
        transfer(bytes + done, static_cast<int>(std::min<std::uint64_t>(most, size - done)));
    };
    if (rank != 0)
      {
        const std::uint64_t size = own.size() * sizeof(Value);
        MPI_Send(&size, 1, MPI_UINT64_T, 0, tag, communicator);
        in_parts(reinterpret_cast<const char *>(own.data()), size, [&](const char *part, int n) {
          MPI_Send(part, n, MPI_BYTE, 0, tag, communicator);
        });
        return;
      }
    use(own);
    Container other;
    for (unsigned int from = 1; from < n_proc; ++from)
      {
        std::uint64_t size = 0;
        MPI_Recv(&size, 1, MPI_UINT64_T, from, tag, communicator, MPI_STATUS_IGNORE);
        other.resize(size / sizeof(Value));
        in_parts(reinterpret_cast<char *>(other.data()), size, [&](char *part, int n) {
          MPI_Recv(part, n, MPI_BYTE, from, tag, communicator, MPI_STATUS_IGNORE);
        });
        use(other);
      }
  }
} // namespace PeriDeal
