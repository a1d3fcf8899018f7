// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/process_end.h>
#include <perideal/base/user_error.h>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/time.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <memory>
#include <new>

namespace PeriDeal
{
  namespace
  {
    /**
     * What set_farewell() was given. A handler reads it, so it never changes once it is published.
     */
    struct Farewell
    {
      std::string file, part, text, message;
    };

    std::atomic<const Farewell *>    farewell{nullptr};
    std::unique_ptr<const Farewell>  current, previous; // a handler may still read the one before
    std::atomic<const std::string *> unfinished{nullptr};
    std::string                      unfinished_files[2];
    bool                             speaker            = false;
    bool                             has_company        = false;
    thread_local bool                memory_was_refused = false;

    std::atomic<bool>   stoppable{false};
    std::atomic<int>    stop_signal{0}; // that a run has been asked to stop by
    std::atomic<time_t> stop_asked{0};  // when, in seconds
    std::atomic<time_t> woken{-1000};   // by SIGCONT, when

    const char *const out_of_memory =
      "out of memory. `perideal check` tells what a scene needs; a coarser lattice, fewer 'Models' or a smaller 'Horizon ratio' need less.";


    // The functions below run in signal handlers: system calls only, no memory.

    void write_all(const int file, const char *text, std::size_t length)
    {
      while (length > 0)
        {
          const ssize_t n = write(file, text, length);
          if (n <= 0)
            return;
          text += n;
          length -= static_cast<std::size_t>(n);
        }
    }


    void say(const char *text)
    {
      if (speaker)
        write_all(STDERR_FILENO, text, std::strlen(text));
    }


    void leave_in_order(const Farewell *last)
    {
      if (const std::string *file = unfinished.load())
        unlink(file->c_str());
      if (last == nullptr || last->file.empty())
        return;
      const int file = open(last->part.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
      if (file < 0)
        return;
      write_all(file, last->text.c_str(), last->text.size());
      if (close(file) == 0)
        rename(last->part.c_str(), last->file.c_str());
    }


    const char *name_of_request(const int signal)
    {
      return signal == SIGINT  ? "an interrupt (SIGINT)" :
             signal == SIGUSR1 ? "a request to stop (SIGUSR1)" :
                                 "a request to end (SIGTERM)";
    }


    time_t seconds_now()
    {
      timespec now = {};
      clock_gettime(CLOCK_MONOTONIC, &now);
      return now.tv_sec;
    }


    /**
     * Open MPI's launcher, when it is interrupted, wakes its processes (SIGCONT), tells them to end
     * (SIGTERM) and kills them a second later, unless odls_base_sigkill_timeout says otherwise.
     */
    void wake(int)
    {
      woken = seconds_now();
    }


    /** The alarm rings, see give_up(), shortly before the process is killed. */
    void expect_to_be_killed()
    {
      const itimerval shortly_before = {{0, 0}, {0, 850000}};
      setitimer(ITIMER_REAL, &shortly_before, nullptr);
    }


    /** Whether the run will see to it. */
    bool is_request(const int signal)
    {
      constexpr time_t same_moment = 2;
      const time_t     now         = seconds_now();
      if (!stoppable.load())
        return false;
      if (stop_signal.load() != 0)
        return now - stop_asked.load() <= same_moment;
      stop_asked  = now;
      stop_signal = signal;
      say("\nperideal: stopping, by ");
      say(name_of_request(signal));
      if (signal == SIGTERM && now - woken.load() <= same_moment)
        {
          expect_to_be_killed();
          say(" of the launcher ...\n");
        }
      else
        say(", as soon as the state can be kept; once more ends at once ...\n");
      return true;
    }


    /** At once. What is written then was prepared. */
    [[noreturn]] void end_now(const int signal)
    {
      const Farewell *last = farewell.load();
      leave_in_order(last);
      say("\nperideal: stopped by ");
      say(name_of_request(signal));
      say(".");
      if (last != nullptr)
        {
          say(" ");
          say(last->message.c_str());
        }
      say("\n");
      _exit(static_cast<int>(ExitStatus::stopped));
    }


    void stop(int signal)
    {
      if (!is_request(signal))
        end_now(signal);
    }


    /** Another process may have the same to say, and ends this one meanwhile. */
    void prepare_to_speak()
    {
      leave_in_order(farewell.load());
      if (speaker)
        return;
      const timespec a_while = {2, 0};
      nanosleep(&a_while, nullptr);
      speaker = true;
    }


    bool say_if_memory_is_short()
    {
      if (!memory_is_short())
        return false;
      say("\nperideal: error: ");
      say(out_of_memory);
      say("\n");
      return true;
    }


    /**
     * The launcher is about to kill this process, and its step is not done; or memory was refused,
     * and nobody has come to say so.
     */
    void give_up(int)
    {
      if (const int signal = stop_signal.load(); signal != 0)
        end_now(signal);
      prepare_to_speak();
      say("\nperideal: error: ");
      say(out_of_memory);
      say("\n");
      _exit(static_cast<int>(ExitStatus::error));
    }


    /** A library may swallow the exception of one process while the others wait for that one. */
    void expect_an_end()
    {
      constexpr unsigned int seconds = 20;
      if (has_company)
        alarm(seconds);
    }


    [[maybe_unused]] void fail(int signal) // not with sanitizers
    {
      prepare_to_speak();
      if (say_if_memory_is_short())
        _exit(static_cast<int>(ExitStatus::error));
      if (signal == SIGBUS)
        {
          say(
            "\nperideal: error: a file in shared memory could not grow (bus error): is the folder for temporary files (TMPDIR) or "
            "/dev/shm full?\n");
          _exit(static_cast<int>(ExitStatus::error));
        }
      say("\nperideal: internal error: ");
      say(signal == SIGSEGV ? "segmentation fault" :
          signal == SIGABRT ? "the program called abort()" :
          signal == SIGFPE  ? "a forbidden arithmetic operation" :
                              "a forbidden instruction");
      say(". Please report it with the scene file.\n");
      _exit(static_cast<int>(ExitStatus::fault));
    }


    void set_default(const char *name, const char *value)
    {
      setenv(name, value, 0);
    }
  } // namespace


  int leave_after_abort()
  {
    prepare_to_speak();
    if (say_if_memory_is_short())
      return static_cast<int>(ExitStatus::error);
    say("\nperideal: internal error: a library gave up. Please report it with the scene file.\n");
    return static_cast<int>(ExitStatus::fault);
  }


  void prepare_mpi_environment()
  {
    set_default("PMIX_MCA_gds", "hash");
    for (const char *launched : {"OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMI_RANK"})
      if (std::getenv(launched) != nullptr)
        return;
    set_default("OMPI_MCA_ess_singleton_isolated", "1");
    set_default("OMPI_MCA_orte_create_session_dirs", "0"); // all such processes would share one
    set_default("OMPI_MCA_btl", "self");
    set_default("OMPI_MCA_pml", "ob1");
  }


  void handle_signals(const bool speaks, const bool alone)
  {
    speaker       = speaks;
    has_company   = !alone;
    const auto on = [](const int signal, void (*handler)(int), const int flags) {
      struct sigaction action = {};
      action.sa_handler       = handler;
      action.sa_flags         = flags;
      sigemptyset(
        &action.sa_mask); // one process that fails is told to end when another one has spoken
      sigaction(signal, &action, nullptr);
    };
    for (const int signal : {SIGTERM, SIGINT, SIGUSR1})
      on(signal, stop, SA_RESTART);
    on(SIGALRM, give_up, 0);
    on(SIGCONT, wake, SA_RESTART);
    std::signal(SIGXFSZ,
                SIG_IGN); // a file that would grow beyond a limit: writing fails, which is checked
#ifndef __SANITIZE_ADDRESS__ // it has handlers of its own
    // A stack that is full holds no handler.
    static char alternative[1 << 16];
    stack_t     stack = {};
    stack.ss_sp       = alternative;
    stack.ss_size     = sizeof alternative;
    sigaltstack(&stack, nullptr);
    for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT})
      on(signal, fail, SA_ONSTACK);
#endif
  }


  void set_stoppable(const bool run_asks)
  {
    stop_asked  = 0;
    stop_signal = 0;
    stoppable   = run_asks;
  }


  bool stop_requested()
  {
    return stop_signal.load() != 0;
  }


  std::string stop_reason()
  {
    const int signal = stop_signal.load();
    return signal == 0 ? "" : name_of_request(signal);
  }


  void set_farewell(const std::string &file, const std::string &text, const std::string &message)
  {
    previous = std::move(current);
    current  = std::make_unique<const Farewell>(Farewell{file, file + ".part", text, message});
    farewell = current.get();
  }


  void clear_farewell()
  {
    farewell = nullptr;
    previous.reset();
    current.reset();
  }


  void set_unfinished_file(const std::string &file)
  {
    // Two in turn, since a handler may read the one that is published.
    std::string &next = unfinished.load() == &unfinished_files[0] ? unfinished_files[1] :
                                                                    unfinished_files[0];
    next              = file;
    unfinished        = file.empty() ? nullptr : &next;
  }


  namespace
  {
    /** While it lives, refused memory is remembered. */
    class MemoryWatch
    {
    public:
      MemoryWatch()
        : previous_handler(std::set_new_handler([] {
          memory_was_refused = true;
          expect_an_end();
          throw std::bad_alloc();
        }))
      {
        memory_was_refused = false;
      }

      ~MemoryWatch()
      {
        alarm(0);
        std::set_new_handler(previous_handler);
      }

    private:
      const std::new_handler previous_handler;
    };
  } // namespace


  void with_memory_errors(const std::function<void()> &action)
  {
    try
      {
        const MemoryWatch watch;
        action();
      }
    catch (const UserError &)
      {
        throw;
      }
    catch (const Stopped &)
      {
        throw;
      }
    catch (...) // also the numbers that Trilinos throws
      {
        AssertThrow(!memory_was_refused && !memory_is_short(), UserError(out_of_memory));
        throw;
      }
  }


  bool memory_is_short()
  {
    constexpr std::size_t little = std::size_t(1) << 26;
    void *const           block =
      mmap(nullptr, little, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (block == MAP_FAILED)
      return true;
    munmap(block, little);
    return false;
  }
} // namespace PeriDeal
