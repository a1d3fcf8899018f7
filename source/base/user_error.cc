// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/user_error.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <thread>
#include <vector>

namespace PeriDeal
{
  UserError::UserError(const std::string &message)
    : text(message)
  {
    // A file that is none of ours may have one line of any length, which messages quote.
    constexpr std::size_t most = 4000, end = 500;
    if (text.size() > most)
      text = text.substr(0, most - end) + " [...] " + text.substr(text.size() - end);
  }


  void UserError::print_info(std::ostream &out) const
  {
    out << "    " << text << std::endl;
  }


  void throw_on_all_if_any(const MPI_Comm communicator, const std::string &message)
  {
    const unsigned int rank   = dealii::Utilities::MPI::this_mpi_process(communicator);
    const unsigned int n_proc = dealii::Utilities::MPI::n_mpi_processes(communicator);
    const unsigned int first =
      dealii::Utilities::MPI::min(message.empty() ? n_proc : rank, communicator);
    if (first == n_proc)
      return;
    const std::string text = dealii::Utilities::MPI::broadcast(communicator, message, first);
    AssertThrow(false, UserError(text));
  }


  bool all_processes_arrive(const MPI_Comm communicator)
  {
    MPI_Request request;
    MPI_Ibarrier(communicator, &request);
    int done = 0;
    for (unsigned int tenths = 0; tenths < 50 && done == 0; ++tenths)
      {
        MPI_Test(&request, &done, MPI_STATUS_IGNORE);
        if (done == 0)
          std::this_thread::sleep_for(std::chrono::milliseconds(100));
      }
    return done != 0;
  }


  unsigned int edit_distance(const std::string &a, const std::string &b)
  {
    const auto same = [](const char x, const char y) {
      return std::tolower(static_cast<unsigned char>(x)) ==
             std::tolower(static_cast<unsigned char>(y));
    };
    const std::size_t n = b.size();
    if (std::max(a.size(), n) > 200) // no name
      return static_cast<unsigned int>(std::max(a.size(), n));
    std::vector<unsigned int> before(n + 1), last(n + 1), now(n + 1);
    for (std::size_t j = 0; j <= n; ++j)
      last[j] = static_cast<unsigned int>(j);
    for (std::size_t i = 1; i <= a.size(); ++i)
      {
        now[0] = static_cast<unsigned int>(i);
        for (std::size_t j = 1; j <= n; ++j)
          {
            const unsigned int replace = last[j - 1] + (same(a[i - 1], b[j - 1]) ? 0 : 1);
            now[j]                     = std::min({replace, last[j] + 1, now[j - 1] + 1});
            if (i > 1 && j > 1 && same(a[i - 1], b[j - 2]) && same(a[i - 2], b[j - 1]))
              now[j] = std::min(now[j], before[j - 2] + 1);
          }
        before.swap(last);
        last.swap(now);
      }
    return last[n];
  }
} // namespace PeriDeal
