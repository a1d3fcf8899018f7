// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "progress_beat.h"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <limits>


namespace PeriDeal
{
  namespace
  {
    // What goes on in this process, told by steppers and solvers that know nobody who shows it.
    constexpr auto      whole = std::numeric_limits<unsigned long long>::max(); // no bond can break
    std::atomic<double> time_reached{0.};
    std::atomic<unsigned long long> steps_done{0}, equilibria{0}, bonds_broken{whole};


    struct Lock
    {
      explicit Lock(pthread_mutex_t &mutex)
        : mutex(mutex)
      {
        pthread_mutex_lock(&mutex);
      }

      ~Lock()
      {
        pthread_mutex_unlock(&mutex);
      }

      pthread_mutex_t &mutex;
    };


    void copy(char *to, const std::size_t size, const std::string &from)
    {
      std::snprintf(to, size, "%s", from.c_str());
    }


    /** The whole text at once, so that lines of others do not come between. */
    void write_out(const char *text, const std::size_t size)
    {
      std::size_t written = 0;
      while (written < size)
        {
          const ssize_t n = ::write(STDOUT_FILENO, text + written, size - written);
          if (n < 0 && errno == EINTR)
            continue;
          if (n <= 0) // nobody listens
            return;
          written += static_cast<std::size_t>(n);
        }
    }
  } // namespace


  void tell_step(const double t)
  {
    time_reached.store(t, std::memory_order_relaxed);
    steps_done.fetch_add(1, std::memory_order_relaxed);
  }


  void tell_equilibrium()
  {
    equilibria.fetch_add(1, std::memory_order_relaxed);
  }


  void tell_broken_bonds(const unsigned long long n)
  {
    bonds_broken.store(n, std::memory_order_relaxed);
  }


  Progress::Beat::Beat(const bool terminal, const double interval)
    : terminal(terminal)
    , interval(interval)
    , made(Clock::now())
    , last_told(made)
  {
    steps_done   = 0;
    equilibria   = 0;
    bonds_broken = whole;
    pthread_condattr_t clock;
    pthread_condattr_init(&clock);
    pthread_condattr_setclock(&clock, CLOCK_MONOTONIC);
    pthread_cond_init(&wake, &clock);
    pthread_condattr_destroy(&clock);
    pthread_mutex_init(&mutex, nullptr);
    pthread_attr_t small;
    pthread_attr_init(&small);
    pthread_attr_setstacksize(&small, 256 * 1024);
    sigset_t all, before; // signals are for the run's own thread
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    runs = pthread_create(&thread, &small, &Beat::loop, this) == 0;
    pthread_sigmask(SIG_SETMASK, &before, nullptr);
    pthread_attr_destroy(&small);
  }


  Progress::Beat::~Beat()
  {
    {
      const Lock lock(mutex);
      stop = true;
      pthread_cond_signal(&wake);
    }
    if (runs)
      pthread_join(thread, nullptr);
    clear();
    pthread_cond_destroy(&wake);
    pthread_mutex_destroy(&mutex);
  }


  void *Progress::Beat::loop(void *self)
  {
    Beat               &beat = *static_cast<Beat *>(self);
    const Lock          lock(beat.mutex);
    const double        pause   = beat.terminal ? std::min(1., beat.interval) : 0.1 * beat.interval;
    constexpr long long billion = 1000000000;
    while (!beat.stop)
      {
        timespec until;
        clock_gettime(CLOCK_MONOTONIC, &until);
        const long long nanoseconds = until.tv_nsec + static_cast<long long>(pause * billion);
        until.tv_sec += nanoseconds / billion;
        until.tv_nsec = nanoseconds % billion;
        pthread_cond_timedwait(&beat.wake, &beat.mutex, &until);
        const double silent = std::chrono::duration<double>(Clock::now() - beat.last_told).count();
        if (!beat.stop && (beat.terminal || silent >= 0.85 * beat.interval))
          beat.tell();
      }
    return nullptr;
  }


  bool Progress::Beat::Span::is_open() const
  {
    return t_to > t_from;
  }


  double Progress::Beat::Span::share_at(const double t) const
  {
    if (!is_open())
      return done_from;
    return done_from + std::clamp((t - t_from) / (t_to - t_from), 0., 1.) * (done_to - done_from);
  }


  int Progress::Beat::describe(char *text, const std::size_t size, const double share)
  {
    const auto   now = Clock::now();
    const double left =
      counts ? bar.remaining.update(std::chrono::duration<double>(now - bar.start).count(), share) :
               -1.;
    char elapsed[40], rest[40];
    format_duration(elapsed, sizeof elapsed, std::chrono::duration<double>(now - made).count());
    int        n   = 0;
    const auto add = [&](const char *format, auto... values) {
      if (n >= 0 && static_cast<std::size_t>(n) < size)
        n += std::snprintf(text + n, size - n, format, values...);
    };
    const unsigned long long steps = steps_done, sought = equilibria, broken = bonds_broken;
    if (span.is_open() && steps > 0)
      add(": t = %.4g, step %llu", time_reached.load(), steps);
    if (doing[0] != '\0')
      add("%s %s", n > 0 ? "," : ":", doing);
    if (state[0] != '\0')
      add("%s %s", n > 0 ? "," : ":", state);
    if (sought > 1)
      add(", equilibrium %llu", sought);
    const bool may_break = broken != whole;
    if (may_break && broken > 0)
      add(", %llu broken bonds", broken);
    add("; %s elapsed", elapsed);
    // How many equilibria are still to come nobody knows, once bonds break between them.
    const bool known = !may_break || sought == 0 || broken == 0;
    if (!known)
      add(", time left unknown");
    else if (left >= 0.)
      {
        format_duration(rest, sizeof rest, left);
        add(may_break && sought > 0 ? ", %s left or more" : ", about %s left", rest);
      }
    return std::min<int>(n, static_cast<int>(size) - 1);
  }


  void Progress::Beat::tell()
  {
    char         text[600];
    const double share = span.share_at(time_reached.load(std::memory_order_relaxed));
    int          n     = 0;
    if (!terminal)
      {
        n = counts ? std::snprintf(text,
                                   sizeof text,
                                   "  %s %d %%",
                                   bar.label,
                                   static_cast<int>(100. * share)) :
                     std::snprintf(text, sizeof text, "  at work");
        n += describe(text + n, sizeof text - n - 1, share);
        text[n++] = '\n';
        last_told = Clock::now();
        return write_out(text, n);
      }
    if (!counts)
      return;
    constexpr int width  = 20;
    const int     filled = static_cast<int>(std::lround(width * std::clamp(share, 0., 1.)));
    n                    = std::snprintf(text,
                      sizeof text,
                      "\r  %s [%.*s%.*s] %d %%",
                      bar.label,
                      filled,
                      "####################",
                      width - filled,
                      "....................",
                      static_cast<int>(100. * share));
    n += describe(text + n, sizeof text - n - 1, share);
    // One line of a narrow terminal, whose rest is overwritten.
    constexpr int columns = 100;
    while (n < columns)
      text[n++] = ' ';
    write_out(text, std::min(n, columns));
    last_told = Clock::now();
  }


  void Progress::Beat::begin(const std::string &what)
  {
    const Lock lock(mutex);
    counts = true;
    bar    = Bar();
    span   = Span();
    copy(bar.label, sizeof bar.label, what);
    bar.start = bar.last_tenth_told = Clock::now();
  }


  void Progress::Beat::set_doing(const std::string &what)
  {
    const Lock lock(mutex);
    copy(doing, sizeof doing, what);
  }


  void Progress::Beat::set_state(const std::string &what)
  {
    const Lock lock(mutex);
    copy(state, sizeof state, what);
  }


  void Progress::Beat::set_span(const double t,
                                const double t_end,
                                const double done,
                                const double done_at_end)
  {
    const Lock lock(mutex);
    time_reached = t;
    span         = {t, t_end, done, done_at_end};
  }


  void Progress::Beat::update(const double share)
  {
    const Lock lock(mutex);
    if (span.is_open())
      time_reached = std::max(time_reached.load(), span.t_from);
    const auto now = Clock::now();
    if (share > span.done_to || !span.is_open())
      span = {0., 0., share, share};
    const bool tenth = static_cast<int>(10. * share) > bar.last_tenth && share < 1. &&
                       std::chrono::duration<double>(now - bar.last_tenth_told).count() > 2.;
    if (!terminal && !tenth)
      return;
    if (terminal && std::chrono::duration<double>(now - last_told).count() < 0.2)
      return;
    bar.last_tenth      = static_cast<int>(10. * share);
    bar.last_tenth_told = now;
    tell();
  }


  void Progress::Beat::clear()
  {
    if (!terminal || !counts)
      return;
    char blank[103];
    std::memset(blank, ' ', sizeof blank);
    blank[0] = blank[101] = '\r';
    write_out(blank, 102);
  }


  void Progress::Beat::postpone()
  {
    const Lock lock(mutex);
    last_told = Clock::now();
  }
} // namespace PeriDeal
