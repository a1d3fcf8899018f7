// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <exception>
#include <functional>
#include <string>

namespace PeriDeal
{
  /** What the status of a process means to whoever started it. */
  enum class ExitStatus
  {
    complete = 0,
    error    = 1, // of the user or of the machine, or a run that diverged
    fault    = 2, // of the program
    stopped  = 3  // by a signal or the limit of its wall time
  };


  /**
   * A run has stopped before its end, in order: its state is kept, to be gone on with. Thrown on
   * all processes; no error.
   */
  class Stopped : public std::exception
  {
  public:
    /** @param message sentences for the user: why, when, and where the state is kept */
    explicit Stopped(const std::string &message)
      : text(message)
    {}

    const char *what() const noexcept override
    {
      return text.c_str();
    }

  private:
    std::string text;
  };


  /**
   * Settings of Open MPI that a run needs and that stand in the environment, unless the user has
   * set them; to be called before MPI_Init.
   *
   * Its directory of keys is kept in memory: the one in shared files below TMPDIR ends in a bus
   * error where that is full. A process that no launcher has started needs no daemon and no
   * transport between processes.
   */
  void prepare_mpi_environment();

  /**
   * From now on SIGTERM, SIGINT and SIGUSR1 end the process with ExitStatus::stopped after what
   * set_farewell() has asked for, unless a run stops by itself (set_stoppable()); faults (a
   * segmentation fault, a bus error, abort()) end it with one message, without a trace, and
   * ExitStatus::fault, or ExitStatus::error if memory has run out. To be called after MPI_Init,
   * which sets handlers of its own.
   *
   * @param speaks whether this process tells the user; one of each run does
   * @param alone  whether the run has no other processes; those would wait for ever for one that
   *               was refused memory inside a library that goes on regardless, so that such a one
   *               ends when nobody has reported it for 20 s
   */
  void handle_signals(const bool speaks, const bool alone);

  /**
   * Whether a run asks stop_requested() often and stops in order then. Between true and false the
   * first of the signals above is a request, which is acknowledged at once; one that comes more
   * than two seconds later ends the process as before. (Who starts a run may send the same signal
   * to it in several ways.) Where Open MPI's launcher is interrupted, which kills its processes a
   * second later, the process ends as before shortly before that.
   */
  void set_stoppable(const bool run_asks);

  /** set_stoppable() while this lives. */
  struct StoppableWhile
  {
    explicit StoppableWhile(const bool run_asks)
    {
      set_stoppable(run_asks);
    }

    ~StoppableWhile()
    {
      set_stoppable(false);
    }

    StoppableWhile(const StoppableWhile &)            = delete;
    StoppableWhile &operator=(const StoppableWhile &) = delete;
  };

  /** Whether a signal has asked this process to stop. Others may not know yet. */
  bool stop_requested();

  /** By what: `an interrupt (SIGINT)`; empty if nothing has. */
  std::string stop_reason();

  /**
   * A library ends all processes by MPI_Abort(): what set_farewell() has asked for, and one
   * message. Returns the status to end with. A program calls it from an MPI_Abort of its own, which
   * takes the place of the library's.
   */
  int leave_after_abort();

  /**
   * What a process that is told to end still does: the file is replaced as a whole by the text,
   * then the message is printed. Only what is prepared here can be written then, since nothing may
   * be computed in a signal handler.
   */
  void set_farewell(const std::string &file, const std::string &text, const std::string &message);

  /** Nothing is to be written any more. */
  void clear_farewell();

  /**
   * A file that is being written and is of no use until it is whole: removed if the process ends
   * before. Empty: none.
   */
  void set_unfinished_file(const std::string &file);

  /** Whether the machine, or a limit of the process, refuses more memory at this moment. */
  bool memory_is_short();

  /**
   * Do it; where memory runs out, by an exception of C++, of deal.II or of a library that was
   * refused some and fails over that, throws a UserError that says so and what needs less.
   */
  void with_memory_errors(const std::function<void()> &action);
} // namespace PeriDeal
