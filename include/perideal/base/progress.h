// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <mpi.h>

#include <chrono>
#include <memory>
#include <string>

namespace PeriDeal
{
  /**
   * The time that a run still needs, from the share that is done. What it says follows the time
   * that passes, and changes besides by a factor of 1.5 in a twentieth of the whole run, or half a
   * minute, at most, however unevenly a run advances. It does not shrink while nothing gets done.
   */
  class RemainingTime
  {
  public:
    /**
     * @param spent seconds since the start; @param done share in (0, 1]. Returns seconds, negative
     *              as long as too little is known.
     */
    double update(const double spent, const double done);

  private:
    double shown = -1., last = 0., last_done = 0.;
  };


  /**
   * What a run tells the user while it goes on, from rank 0 only: plain lines, and a progress bar
   * with the remaining time on a terminal. In a log, a line per tenth, and one at least every 30 s
   * with what the run is at: a thread of its own writes it, which waits for nothing.
   */
  class Progress
  {
  public:
    /** @param interval in seconds, between two lines of a log at most */
    Progress(const MPI_Comm communicator, const bool quiet, const double interval = 30.);
    ~Progress();
    Progress(const Progress &)            = delete;
    Progress &operator=(const Progress &) = delete;

    /** One line, at once. */
    void line(const std::string &text) const;

    /** A note or warning, marked as such. */
    void note(const std::string &text) const;

    /** Start a bar. */
    void begin(const std::string &what);

    /** @param done fraction in [0, 1] */
    void update(const double done);

    /** What is going on from now on, as in `building peridynamics`. */
    void doing(const std::string &what) const;

    /** What there is to know of the results so far, as in `force on top in y 12.3`. */
    void state(const std::string &what) const;

    /**
     * Until the next call, steps go from @p t to @p t_end (tell_step()), and with them the share
     * done.
     */
    void advancing(const double t,
                   const double t_end,
                   const double done,
                   const double done_at_end) const;

    /** No more is told of what goes on. */
    void end() const;

    /** Seconds since this was made. */
    double elapsed() const;

  private:
    struct Beat;

    /** Null where nothing is told. */
    Beat *beat_now() const;

    bool                                        active, terminal;
    const double                                interval;
    const std::chrono::steady_clock::time_point start;
    mutable std::unique_ptr<Beat>               beat;
  };

  /** To be called by steppers after each step: where they are. Costs nothing. */
  void tell_step(const double t);

  /** To be called before an equilibrium is sought. Costs nothing. */
  void tell_equilibrium();

  /** To be called as bonds break: how many of the body have. */
  void tell_broken_bonds(const unsigned long long n);

  /** 1.5 s, 2 min 5 s, 3 h 10 min. */
  std::string readable_duration(const double seconds);

  /** 12.3 MB and the like. */
  std::string readable_bytes(const double bytes);

  /** 1234567 as 1,234,567. */
  std::string readable_count(const unsigned long long n);
} // namespace PeriDeal
