// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/archive.h>

#include <nlohmann/json.hpp>

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace PeriDeal
{
  class Hdf5File;
  class Hdf5Input;

  /** What a checkpoint says of the run that wrote it. */
  struct CheckpointHeader
  {
    std::string  program; // its version
    std::string  scene;   // with all defaults, as scene_with_defaults() gives it
    unsigned int dim = 0, n_processes = 0;
    double       time      = 0.; // simulated
    double       wall_time = 0.; // spent until then, in seconds
    /** Checksums of the files that the scene names, by `Section/Entry`. */
    std::map<std::string, std::string> files;
  };


  /*
   * A checkpoint is an HDF5 file behind a head of 512 bytes, which is text: `PeriDeal checkpoint 2`
   * (the number of the format), the length of the file in bytes, and the checksum of all behind the
   * head. The file has
   *
   * - `/scene`, the scene with its defaults, and `/index`, JSON: the rest of the header, and the
   *   names and sizes of all below, in their order;
   * - `/numbers`, `/texts` and `/shares`, each name's one after the other; of a share one number
   *   for each process;
   * - `/keys/N`, the keys of nodes in the order of the processes, once for all vectors that have
   *   the same; the index has the number and the checksum of each process's;
   * - `/vectors/NAME`, a row for each node in the order of its keys;
   * - `/pairs/NAME/keys` and `/pairs/NAME/values`, a row for each pair, by process.
   *
   * Rank 0 writes and reads, and never holds the values of two processes.
   */

  /** The keys of all processes, as far as is needed to know them again. */
  struct KeySet
  {
    std::vector<std::uint64_t> counts, checksums; // of the processes

    bool operator<(const KeySet &other) const;

    /** Collective. */
    static KeySet of(const NodeKeys &keys, const MPI_Comm communicator);
  };


  /** Saves into a new file `NAME.part`, which has its name when all is in it and on the disk. */
  class CheckpointWriter : public Archive
  {
  public:
    CheckpointWriter(const std::string      &name,
                     const CheckpointHeader &header,
                     const MPI_Comm          communicator);

    /** Without finish() nothing is left. */
    ~CheckpointWriter() override;

    bool loads() const override
    {
      return false;
    }

    /**
     * All has been saved. Returns 0 on all processes, or the error number of the first failure (-1
     * if the system gave none); nothing is left of the file then. Collective.
     */
    int finish();

  private:
    void take(const std::string &name, std::vector<double> &values) override;
    void take(const std::string &name, std::string &value) override;
    void take_share(const std::string &name, double &value) override;
    void take(const std::string &name,
              double            *values,
              const std::size_t  n_per_node,
              const NodeKeys    &keys) override;
    void take(const std::string &name, KeyedPairs &pairs, const NodeKeys &keys) override;

    /** Write a table of what all processes have, in turn. */
    template <typename number>
    void write(const std::string         &table,
               const std::vector<number> &own,
               const std::size_t          n_rows,
               const std::size_t          n_columns);

    /** The number of a set of keys, which is written if it is new. */
    unsigned int number_of(const NodeKeys &keys);

    const std::string              name;
    const CheckpointHeader         header;
    const MPI_Comm                 communicator;
    std::unique_ptr<Hdf5File>      file; // on rank 0
    nlohmann::ordered_json         index;
    std::vector<double>            numbers, shares;
    std::string                    texts;
    std::map<KeySet, unsigned int> sets;
  };


  /** Loads from a file that is whole (see fault_of_checkpoint()), on any number of processes. */
  class CheckpointReader : public Archive
  {
  public:
    /** Throws UserError. Collective. */
    CheckpointReader(const std::string &name, const MPI_Comm communicator);
    ~CheckpointReader() override;

    bool loads() const override
    {
      return true;
    }

    const CheckpointHeader &header() const
    {
      return of_run;
    }

  private:
    using Json = nlohmann::ordered_json;

    void take(const std::string &name, std::vector<double> &values) override;
    void take(const std::string &name, std::string &value) override;
    void take_share(const std::string &name, double &value) override;
    void take(const std::string &name,
              double            *values,
              const std::size_t  n_per_node,
              const NodeKeys    &keys) override;
    void take(const std::string &name, KeyedPairs &pairs, const NodeKeys &keys) override;

    /** Rows of the file that a process wants, in their order, and where each goes. */
    struct Places
    {
      std::vector<std::uint64_t> rows, targets;
      bool                       fit = false; // all nodes have one row, all rows one node
    };

    void          check(const bool good, const std::string &problem) const;
    const Json   &entry(const std::string &kind, const std::string &name) const;
    const Places &places_of(const unsigned int number, const NodeKeys &keys, const KeySet &of_keys);

    /** Blocks of rows of a table to all processes; @p use gets the first row and the values. */
    template <typename number, typename Use>
    void for_each_block(const std::string &table,
                        const std::size_t  n_rows,
                        const std::size_t  n_columns,
                        const Use         &use) const;

    const std::string                                 name;
    const MPI_Comm                                    communicator;
    std::unique_ptr<Hdf5Input>                        file; // on rank 0
    CheckpointHeader                                  of_run;
    Json                                              index;
    std::map<std::string, std::vector<double>>        numbers, shares;
    std::map<std::string, std::string>                texts;
    std::vector<KeySet>                               sets;
    std::map<std::pair<unsigned int, KeySet>, Places> places;
  };


  /**
   * Why a file is no whole checkpoint of this version of the format, as it goes behind its name in
   * a message: "is cut short"; empty if it is one. Reads all of it. Not collective.
   */
  std::string fault_of_checkpoint(const std::string &name);


  /** What writing and reading of checkpoints agree on; checkpoint_file.h says all. */
  namespace CheckpointFormat
  {
    constexpr std::size_t head_size = 512;
    constexpr const char *title     = "PeriDeal checkpoint ";
    constexpr unsigned    number    = 2;
  } // namespace CheckpointFormat
} // namespace PeriDeal
