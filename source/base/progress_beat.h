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

    /** From begin() on, until the next. */
    struct Bar
    {
      char              label[64]  = "";
      int               last_tenth = 0;
      Clock::time_point start, last_tenth_told;
      RemainingTime     remaining;
    };

    /** Times and shares done at both ends of what is under way. */
    struct Span
    {
      bool   is_open() const;
      double share_at(const double t) const;

      double t_from = 0., t_to = 0., done_from = 0., done_to = 0.;
    };

    static void *loop(void *self);
    void         tell();
    int          describe(char *text, const std::size_t size, const double share);

    const bool        terminal;
    const double      interval;
    pthread_t         thread;
    bool              runs = false, stop = false, counts = false;
    pthread_mutex_t   mutex;
    pthread_cond_t    wake;
    char              doing[160] = "", state[200] = "";
    Bar               bar;
    Span              span;
    Clock::time_point made, last_told;
  };


  /** readable_duration() without an allocation. */
  void format_duration(char *text, const std::size_t size, const double seconds);
} // namespace PeriDeal
