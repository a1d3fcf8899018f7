// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/progress.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>

#include "progress_beat.h"

namespace PeriDeal
{
  double RemainingTime::update(const double spent, const double done)
  {
    constexpr double least_share = 0.005, least_time = 3., factor = 1.5;
    if (done < least_share || spent < least_time)
      return -1.;
    const double found  = spent * std::max(0., 1. - done) / done,
                 passed = std::max(0., spent - last),
                 span   = std::clamp(0.05 * (spent + found), 1., 30.);
    // While nothing gets done less time passes than is needed: what is told may grow, not shrink.
    const bool advances = done > last_done;
    if (shown < 0.)
      shown = found;
    else
      {
        const double expected = advances ? std::max(0., shown - passed) : shown,
                     most     = std::pow(factor, passed / span);
        // Near the end a second more is no factor.
        shown =
          std::clamp(found, advances ? expected / most : expected, expected * most + (most - 1.));
      }
    last      = spent;
    last_done = done;
    return shown;
  }


  Progress::Progress(const MPI_Comm communicator, const bool quiet, const double interval)
    : active(false)
    , terminal(isatty(STDOUT_FILENO) != 0 && isatty(STDERR_FILENO) != 0)
    , interval(interval)
    , start(std::chrono::steady_clock::now())
  {
    int rank = 0;
    MPI_Comm_rank(communicator, &rank);
    active = rank == 0 && !quiet;
    // (mpirun gives its processes a terminal as output even where it writes into a file itself, but
    // a pipe for messages.) A script that passes our output on through a pipe says what is at its
    // end.
    if (const char *wanted = std::getenv("PERIDEAL_PROGRESS"))
      terminal = std::string(wanted) == "bar";
  }


  Progress::~Progress() = default;


  Progress::Beat *Progress::beat_now() const
  {
    if (active && !beat)
      beat = std::make_unique<Beat>(terminal, interval);
    return beat.get();
  }


  void Progress::line(const std::string &text) const
  {
    if (!active)
      return;
    std::cout << text << std::endl;
    if (beat)
      beat->postpone();
  }


  void Progress::note(const std::string &text) const
  {
    line("  note: " + text);
  }


  void Progress::begin(const std::string &what)
  {
    if (Beat *b = beat_now())
      b->begin(what);
  }


  void Progress::update(const double done)
  {
    if (Beat *b = beat_now())
      b->update(done);
  }


  void Progress::doing(const std::string &what) const
  {
    if (Beat *b = beat_now())
      b->set_doing(what);
  }


  void Progress::state(const std::string &what) const
  {
    if (Beat *b = beat_now())
      b->set_state(what);
  }


  void Progress::advancing(const double t,
                           const double t_end,
                           const double done,
                           const double done_at_end) const
  {
    if (Beat *b = beat_now())
      b->set_span(t, t_end, done, done_at_end);
  }


  void Progress::end() const
  {
    beat.reset();
  }


  double Progress::elapsed() const
  {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }


  void format_duration(char *text, const std::size_t size, const double seconds)
  {
    if (seconds < 60.)
      std::snprintf(text, size, seconds < 9.95 ? "%.2g s" : "%.0f s", seconds);
    else if (seconds < 3600.)
      std::snprintf(text,
                    size,
                    "%d min %d s",
                    static_cast<int>(seconds / 60.),
                    static_cast<int>(seconds) % 60);
    else
      std::snprintf(text,
                    size,
                    "%d h %d min",
                    static_cast<int>(seconds / 3600.),
                    static_cast<int>(seconds / 60.) % 60);
  }


  std::string readable_duration(const double seconds)
  {
    char text[64];
    format_duration(text, sizeof text, seconds);
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
