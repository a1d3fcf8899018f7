// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/types.h>

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * Names for the owned nodes of a process, in their order: keys that no two nodes share and that
   * do not depend on the number of processes.
   */
  using NodeKeys = std::vector<std::uint64_t>;


  /** What is kept of some pairs of nodes. */
  struct KeyedPairs
  {
    using Key = std::array<std::uint64_t, 2>;

    std::vector<Key>    keys; // the first node is one that this process owns
    std::vector<double> values;
  };


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

    /** A part of the state, in which names stand for themselves, until this goes out of scope. */
    class Part
    {
    public:
      Part(Archive &archive, const std::string &name);
      ~Part();
      Part(const Part &)            = delete;
      Part &operator=(const Part &) = delete;

    private:
      Archive &archive;
    };

    /** What is the same on all processes. */
    void exchange(const std::string &name, double &value);
    void exchange(const std::string &name, unsigned long long &value);
    void exchange(const std::string &name, unsigned int &value);
    void exchange(const std::string &name, bool &value);
    void exchange(const std::string &name, std::string &value);
    void exchange(const std::string &name, std::vector<double> &values);

    /**
     * This process's share of a sum over all. On another number of processes than saved it, the
     * first process has the whole sum and all others 0.
     */
    void exchange_share(const std::string &name, double &value);

    /**
     * The owned values of a vector, which has its size already, as many for each node; ghosts are
     * left alone.
     */
    void exchange(const std::string &name, Vector &v, const NodeKeys &keys);

    /** Pairs of nodes, in any order. What is set are the pairs of the nodes that have keys here. */
    void exchange(const std::string &name, KeyedPairs &pairs, const NodeKeys &keys);

  protected:
    /** The same for names that are whole: `part/part/name`. Numbers without loss of digits. */
    virtual void take(const std::string &name, std::vector<double> &values)             = 0;
    virtual void take(const std::string &name, std::string &value)                      = 0;
    virtual void take_share(const std::string &name, double &value)                     = 0;
    virtual void take(const std::string &name,
                      double            *values,
                      const std::size_t  n_per_node,
                      const NodeKeys    &keys)                                             = 0;
    virtual void take(const std::string &name, KeyedPairs &pairs, const NodeKeys &keys) = 0;

  private:
    std::string full_name(const std::string &name) const;

    std::vector<std::string> parts;
  };


  /** An archive in memory, the whole of it on each process. */
  class MemoryArchive : public Archive
  {
  public:
    /** To save. */
    explicit MemoryArchive(const MPI_Comm communicator);

    /** To load what @p saved holds, on any processes that have it. */
    MemoryArchive(const MemoryArchive &saved, const MPI_Comm communicator);

    bool loads() const override
    {
      return is_loading;
    }

  private:
    void take(const std::string &name, std::vector<double> &values) override;
    void take(const std::string &name, std::string &value) override;
    void take_share(const std::string &name, double &value) override;
    void take(const std::string &name,
              double            *values,
              const std::size_t  n_per_node,
              const NodeKeys    &keys) override;
    void take(const std::string &name, KeyedPairs &pairs, const NodeKeys &keys) override;

    using NodeValues = std::map<std::uint64_t, std::vector<double>>;

    /** The member of this name; on all processes alike. */
    template <typename T>
    T &entry(std::map<std::string, T> &entries, const std::string &name) const;

    const MPI_Comm                             communicator;
    const bool                                 is_loading;
    std::map<std::string, std::vector<double>> numbers;
    std::map<std::string, std::string>         texts;
    std::map<std::string, std::vector<double>> shares; // by process
    std::map<std::string, NodeValues>          vectors;
    std::map<std::string, KeyedPairs>          all_pairs;
  };
} // namespace PeriDeal
