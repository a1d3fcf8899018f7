// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/progress.h>

#include <pthread.h>

#include <cstddef>

namespace PeriDeal
{
  /**
   * The thread that tells what a run is at. It allocates nothing and has a small stack, so that a
   * run has the memory that it has without it, and calls neither MPI nor streams.
   */
  struct Progress::Beat
  {
    Beat(const bool terminal, const double interval);
    ~Beat();

    void begin(const std::string &what);
    void set_doing(const std::string &what);
    void set_state(const std::string &what);
    void set_span(const double t, const double t_end, const double done, const double done_at_end);
    void update(const double share);

    /** Overwrite a bar by nothing. */
    void clear();

    /** A line has been written: the next one is due an interval later. */
    void postpone();

  private:
    using Clock = std::chrono::steady_clock;

    static void *loop(void *self);
    void         tell();
    double       share_done() const;
    int          describe(char *text, const std::size_t size, const double share);

    const bool        terminal;
    const double      interval;
    pthread_t         thread;
    bool              runs = false, stop = false, counts = false;
    pthread_mutex_t   mutex;
    pthread_cond_t    wake;
    char              label[64] = "", doing[160] = "", state[200] = "";
    double            t_from = 0., t_to = 0., done_from = 0., done_to = 0.;
    int               last_tenth = 0;
    RemainingTime     remaining;
    Clock::time_point made, start, last_told, last_tenth_told;
  };
} // namespace PeriDeal
