// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace PeriDeal
{
  namespace InTurn
  {
    constexpr int         tag  = 4711;
    constexpr std::size_t most = std::size_t(1) << 28; // bytes of a message

    /** Do it with one part of the bytes after the other. */
    template <typename Byte, typename Transfer>
    void in_parts(Byte *bytes, const std::uint64_t size, const Transfer &transfer)
    {
      for (std::uint64_t done = 0; done < size; done += most)
        transfer(bytes + done, static_cast<int>(std::min<std::uint64_t>(most, size - done)));
    }
  } // namespace InTurn


  /**
   * Hand the numbers or bytes of each process to rank 0, one process after the other in their
   * order, so that it never holds those of two. @p use is called there with each. Container:
   * contiguous, of a type that may be copied byte by byte. Collective.
   */
  template <typename Container, typename Use>
  void gather_in_turn(const Container &own, const MPI_Comm communicator, const Use &use)
  {
    using Value               = typename Container::value_type;
    const unsigned int rank   = dealii::Utilities::MPI::this_mpi_process(communicator);
    const unsigned int n_proc = dealii::Utilities::MPI::n_mpi_processes(communicator);
    if (rank != 0)
      {
        const std::uint64_t size = own.size() * sizeof(Value);
        MPI_Send(&size, 1, MPI_UINT64_T, 0, InTurn::tag, communicator);
        InTurn::in_parts(reinterpret_cast<const char *>(own.data()),
                         size,
                         [&](const char *part, int n) {
                           MPI_Send(part, n, MPI_BYTE, 0, InTurn::tag, communicator);
                         });
        return;
      }
    use(own);
    Container other;
    for (unsigned int from = 1; from < n_proc; ++from)
      {
        std::uint64_t size = 0;
        MPI_Recv(&size, 1, MPI_UINT64_T, from, InTurn::tag, communicator, MPI_STATUS_IGNORE);
        other.resize(size / sizeof(Value));
        InTurn::in_parts(reinterpret_cast<char *>(other.data()), size, [&](char *part, int n) {
          MPI_Recv(part, n, MPI_BYTE, from, InTurn::tag, communicator, MPI_STATUS_IGNORE);
        });
        use(other);
      }
  }


  /**
   * The opposite: rank 0 gives each process @p n values of its own, one process after the other, so
   * that it never holds those of two. @p read fills there what is of a process, its rank, at an
   * address. Collective.
   */
  template <typename Value, typename Read>
  void scatter_in_turn(Value            *own,
                       const std::size_t n,
                       const MPI_Comm    communicator,
                       const Read       &read)
  {
    const unsigned int rank   = dealii::Utilities::MPI::this_mpi_process(communicator);
    const unsigned int n_proc = dealii::Utilities::MPI::n_mpi_processes(communicator);
    std::uint64_t      size   = n;
    if (rank != 0)
      {
        MPI_Send(&size, 1, MPI_UINT64_T, 0, InTurn::tag, communicator);
        InTurn::in_parts(
          reinterpret_cast<char *>(own),
          n * sizeof(Value),
          [&](char *part, int bytes) {
            MPI_Recv(part, bytes, MPI_BYTE, 0, InTurn::tag, communicator, MPI_STATUS_IGNORE);
          });
        return;
      }
    read(0u, own, n);
    std::vector<Value> other;
    for (unsigned int to = 1; to < n_proc; ++to)
      {
        MPI_Recv(&size, 1, MPI_UINT64_T, to, InTurn::tag, communicator, MPI_STATUS_IGNORE);
        other.resize(size);
        read(to, other.data(), other.size());
        InTurn::in_parts(reinterpret_cast<const char *>(other.data()),
                         size * sizeof(Value),
                         [&](const char *part, int bytes) {
                           MPI_Send(part, bytes, MPI_BYTE, to, InTurn::tag, communicator);
                         });
      }
  }


  /** Give all processes the values that rank 0 has, their number too. Collective. */
  template <typename Container>
  void broadcast_all(Container &values, const MPI_Comm communicator)
  {
    std::uint64_t size = values.size();
    MPI_Bcast(&size, 1, MPI_UINT64_T, 0, communicator);
    values.resize(size);
    InTurn::in_parts(
      reinterpret_cast<char *>(const_cast<typename Container::value_type *>(values.data())),
      size * sizeof(typename Container::value_type),
      [&](char *part, int bytes) { MPI_Bcast(part, bytes, MPI_BYTE, 0, communicator); });
  }
} // namespace PeriDeal
