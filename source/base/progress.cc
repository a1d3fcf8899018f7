// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/progress.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>

namespace PeriDeal
{
  Progress::Progress(const MPI_Comm communicator, const bool quiet)
    : active(false)
    , terminal(isatty(STDOUT_FILENO) != 0 && isatty(STDERR_FILENO) != 0)
  {
    int rank = 0;
    MPI_Comm_rank(communicator, &rank);
    active = rank == 0 && !quiet;
    // (mpirun gives its processes a terminal as output even where it writes into a file itself, but a pipe for messages.)
    // A script that passes our output on through a pipe says what is at its end.
    if (const char *wanted = std::getenv("PERIDEAL_PROGRESS"))
      terminal = std::string(wanted) == "bar";
  }


  void Progress::line(const std::string &text) const
  {
    if (active)
      std::cout << text << std::endl;
  }


  void Progress::note(const std::string &text) const
  {
    line("  note: " + text);
  }


  void Progress::begin(const std::string &what)
  {
    label      = what;
    last_tenth = 0;
    start = last_shown = std::chrono::steady_clock::now();
  }


  std::string Progress::remaining(const double done) const
  {
    const double spent =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return done > 0. ? readable_duration(spent * (1. - done) / done) + " left" : "";
  }


  void Progress::update(const double done)
  {
    if (!active)
      return;
    const auto now = std::chrono::steady_clock::now();
    if (terminal)
      {
        if (std::chrono::duration<double>(now - last_shown).count() < 0.1 && done < 1.)
          return;
        last_shown           = now;
        constexpr int width  = 30;
        const int     filled = static_cast<int>(std::lround(width * std::clamp(done, 0., 1.)));
        std::cout << "\r  " << label << " [" << std::string(filled, '#')
                  << std::string(width - filled, '.') << "] " << static_cast<int>(100. * done)
                  << " %  " << remaining(done) << "      " << std::flush;
      }
    else if (static_cast<int>(10. * done) > last_tenth && done < 1. &&
             std::chrono::duration<double>(now - last_shown).count() > 2.)
      {
        last_tenth = static_cast<int>(10. * done);
        last_shown = now;
        line("  " + label + " " + std::to_string(10 * last_tenth) + " %, " + remaining(done));
      }
  }


  void Progress::end() const
  {
    if (active && terminal)
      std::cout << "\r" << std::string(78, ' ') << "\r" << std::flush;
  }


  std::string readable_duration(const double seconds)
  {
    char text[64];
    if (seconds < 60.)
      std::snprintf(text, sizeof text, seconds < 9.95 ? "%.2g s" : "%.0f s", seconds);
    else if (seconds < 3600.)
      std::snprintf(text,
                    sizeof text,
                    "%d min %d s",
                    static_cast<int>(seconds / 60.),
                    static_cast<int>(seconds) % 60);
    else
      std::snprintf(text,
                    sizeof text,
                    "%d h %d min",
                    static_cast<int>(seconds / 3600.),
                    static_cast<int>(seconds / 60.) % 60);
    return text;
  }


  std::string readable_bytes(const double bytes)
  {
    static const char *const units[] = {"B", "kB", "MB", "GB", "TB"};
    double                   value   = bytes;
    unsigned int             unit    = 0;
    while (value >= 1000. && unit < 4)
      {
        value /= 1000.;
        ++unit;
      }
    char text[64];
    std::snprintf(text,
                  sizeof text,
                  value < 10. && unit > 0 ? "%.1f %s" : "%.0f %s",
                  value,
                  units[unit]);
    return text;
  }


  std::string readable_count(const unsigned long long n)
  {
    std::string text = std::to_string(n);
    for (int i = static_cast<int>(text.size()) - 3; i > 0; i -= 3)
      text.insert(static_cast<std::size_t>(i), ",");
    return text;
  }
} // namespace PeriDeal
