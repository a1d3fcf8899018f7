// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <mpi.h>

#include <set>
#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * Holds a folder for this process by a lock on a file, as long as the object lives. The lock goes
   * with the process, so that one that was killed leaves none. Used on one process of a run.
   */
  class FolderLock
  {
  public:
    FolderLock() = default;
    ~FolderLock();

    FolderLock(const FolderLock &)            = delete;
    FolderLock &operator=(const FolderLock &) = delete;

    enum class Outcome
    {
      held,
      taken, // by another process
      impossible
    };

    /** Take the lock on a file, which is made. */
    Outcome take(const std::string &file);

    /** Who holds it, if it is taken ("process 12 on host since ..."), or why it is impossible. */
    const std::string &explanation() const
    {
      return text;
    }

    /** Let go and remove the file. */
    void release();

  private:
    std::string name, text;
    int         file = -1;
  };


  /** What a run does with the results that lie in its output directory. */
  enum class RunMode
  {
    begin,     // replace them, unless they are those of a run that can be resumed
    overwrite, // replace them
    resume     // go on with them
  };


  /**
   * The output directory of one run. The folder `.perideal` in it holds the list of the files that
   * runs have written there, each named before it is written, a lock while a run goes on, and the
   * results of the run before until the new one has results of its own.
   *
   * - One run at a time: a second one is refused. The lock goes with the process, so that a run
   *   that was killed leaves none.
   * - Only files of the list are ever moved, replaced or deleted; where a file of another origin
   *   has the name of a result, the run is refused.
   * - A run that ends by an error before commit() leaves the directory as it was. One that is
   *   killed or told to end before leaves the results before it in `.perideal/previous`, until
   *   another run has results.
   * - A run that can be resumed has checkpoints in the list (`checkpoints/N.h5`); it is not
   *   replaced unless that is asked for.
   * - A run that is resumed finds all as it was left, and leaves what it cannot go on with.
   *
   * Files are written by rank 0. What goes wrong there is kept, and check() throws it on all
   * processes.
   */
  class ResultFolder
  {
  public:
    /**
     * Takes the directory and, unless it goes on with it, sets aside what an earlier run wrote
     * there.
     *
     * @param scene_file must not be among the results @param names of files that the run is going
     *                   to write or its report is, relative to the directory;
     * `*` at the end stands for anything
     *
     * Throws UserError. Collective.
     */
    ResultFolder(const std::string              &directory,
                 const std::string              &scene_file,
                 const std::vector<std::string> &names,
                 const MPI_Comm                  communicator,
                 const RunMode                   mode = RunMode::begin);

    /** Without commit() everything is as before. */
    ~ResultFolder();

    ResultFolder(const ResultFolder &)            = delete;
    ResultFolder &operator=(const ResultFolder &) = delete;

    const std::string &directory() const
    {
      return path;
    }

    /** This process writes. */
    bool writes() const
    {
      return first_rank;
    }

    /** Those of the run. */
    MPI_Comm processes() const
    {
      return communicator;
    }

    /** Whether results of a run before lie in `.perideal/previous`. Not collective. */
    bool has_earlier_results() const;

    /**
     * Name a file as the run's own, before it is written; returns where it lies, or nothing if it
     * must not be written since the list cannot be. Only where writes().
     */
    std::string claim(const std::string &name);

    /** The same for a file that the run can do without; @p problem 0 or an error number. */
    std::string claim(const std::string &name, int &problem);

    /** Whether the list of the run's own files has this one. Only where writes(). */
    bool lists(const std::string &name) const
    {
      return listed.count(name) > 0;
    }

    /** Write a file whole or not at all. Does nothing where not writes(). */
    void write(const std::string &name, const std::string &text);

    /**
     * Something could not be written, for the reason that the system gave (an error number, 0 if it
     * gave none). The first such message counts.
     */
    void keep_failure(const std::string &name, const int reason);

    /** The same for what is wrong otherwise, a sentence. */
    void keep_failure(const std::string &message);

    /** Throws a UserError on all processes if anything could not be written. Collective. */
    void check() const;

    /** Whether anything could not be written, as far as this process knows. */
    bool failed() const
    {
      return !failure.empty();
    }

    /** The run has results: those of the run before go. */
    void commit();

  private:
    std::string take(const std::string              &scene_file,
                     const std::vector<std::string> &names,
                     const RunMode                   mode);
    std::string file_of_another_origin(const std::vector<std::string> &names,
                                       const std::set<std::string>    &earlier) const;
    bool        is_resumable(const std::set<std::string> &earlier) const;
    void        go_on_with(const std::set<std::string> &earlier);
    void        set_aside(const std::set<std::string> &earlier);
    void        put_back();
    void        restore();

    const std::string     path, own; // the directory, and its folder `.perideal`
    const MPI_Comm        communicator;
    const bool            first_rank;
    std::set<std::string> listed;
    std::string           failure;
    FolderLock            lock;
    bool                  aside = false, committed = false;

    std::vector<std::string> made; // folders that did not exist before, the innermost first
  };


  /**
   * Take away what the list of a directory names, so that nothing of an earlier run can be taken
   * for that of another scene. Call it on one process.
   */
  void remove_results(const std::string &directory);

  /**
   * Write a file whole or not at all (new file, then rename); returns 0 or the error number. Call
   * it on one process.
   */
  int replace_file(const std::string &name, const std::string &text);

  /** What the system says to an error number; 0 and negative ones: that it says nothing. */
  std::string reason_of(const int number);

  /** As replace_file(), throws UserError. */
  void write_file(const std::string &name, const std::string &text);
} // namespace PeriDeal
