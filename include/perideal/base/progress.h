// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <mpi.h>

#include <chrono>
#include <string>

namespace PeriDeal
{
  /**
   * What a run tells the user while it goes on, from rank 0 only: plain lines, and a progress bar with the remaining time on a terminal (in a log, a line
   * per tenth).
   */
  class Progress
  {
  public:
    Progress(const MPI_Comm communicator, const bool quiet);

    /** One line, at once. */
    void line(const std::string &text) const;

    /** A note or warning, marked as such. */
    void note(const std::string &text) const;

    /** Start a bar. */
    void begin(const std::string &what);

    /** @param done fraction in [0, 1] */
    void update(const double done);

    void end() const;

  private:
    std::string remaining(const double done) const;

    bool                                  active, terminal;
    std::string                           label;
    int                                   last_tenth = 0;
    std::chrono::steady_clock::time_point start, last_shown;
  };

  /** 1.5 s, 2 min 5 s, 3 h 10 min. */
  std::string readable_duration(const double seconds);

  /** 12.3 MB and the like. */
  std::string readable_bytes(const double bytes);

  /** 1234567 as 1,234,567. */
  std::string readable_count(const unsigned long long n);
} // namespace PeriDeal
