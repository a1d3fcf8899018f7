// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/types.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * Names for the owned unknowns of a process, in their order: keys that no two unknowns share and
   * that do not depend on the number of processes.
   */
  using UnknownKeys = std::vector<std::uint64_t>;


  /**
   * The state of a run, to be kept or taken up again. A class with a state has one function
   * exchange(Archive &), which does both: it hands over each member by name, and the archive reads
   * the member or sets it. All functions but loads() are collective, and throw UserError where a
   * member to be set is not in the archive.
   */
  class Archive
  {
  public:
    virtual ~Archive() = default;

    /** Members are set; else they are read. */
    virtual bool loads() const = 0;

    /** A number that is the same on all processes. */
    virtual void exchange(const std::string &name, double &value)             = 0;
    virtual void exchange(const std::string &name, unsigned long long &value) = 0;

    void exchange(const std::string &name, bool &value);

    /**
     * This process's share of a sum over all. On another number of processes than saved it, the
     * first process has the whole sum and all others 0.
     */
    virtual void exchange_share(const std::string &name, double &value) = 0;

    /** The owned values of a vector, which has its size already; ghosts are left alone. */
    virtual void exchange(const std::string &name, Vector &v, const UnknownKeys &keys) = 0;
  };


  /** An archive in memory, the whole of it on each process. */
  class MemoryArchive : public Archive
  {
  public:
    /** To save. */
    explicit MemoryArchive(const MPI_Comm communicator);

    /** To load what @p saved holds, on any processes that have it. */
    MemoryArchive(const MemoryArchive &saved, const MPI_Comm communicator);

    bool loads() const override;
    void exchange(const std::string &name, double &value) override;
    void exchange(const std::string &name, unsigned long long &value) override;
    void exchange_share(const std::string &name, double &value) override;
    void exchange(const std::string &name, Vector &v, const UnknownKeys &keys) override;
    using Archive::exchange;

  private:
    using Values = std::map<std::uint64_t, double>; // by unknown

    /** The member of this name; on all processes alike. */
    template <typename T>
    T &entry(std::map<std::string, T> &entries, const std::string &name) const;

    const MPI_Comm                             communicator;
    const bool                                 is_loading;
    std::map<std::string, double>              numbers;
    std::map<std::string, unsigned long long>  counts;
    std::map<std::string, std::vector<double>> shares; // by process
    std::map<std::string, Values>              vectors;
  };
} // namespace PeriDeal
