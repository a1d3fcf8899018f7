// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <string>

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
} // namespace PeriDeal
