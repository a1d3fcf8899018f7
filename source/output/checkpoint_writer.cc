// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/process_end.h>
#include <perideal/output/checkpoint_file.h>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <filesystem>
#include <numeric>
#include <tuple>

#include "checksum.h"
#include "gather_in_turn.h"
#include "hdf5_file.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** Checksum and length of a file whose head is still to come, into that; 0 or an error number.
     */
    int write_head(const int file)
    {
      using namespace CheckpointFormat;
      std::vector<char> buffer(std::size_t(1) << 20);
      Checksum          sum;
      std::size_t       length = head_size;
      for (;;)
        {
          const ssize_t n = pread(file, buffer.data(), buffer.size(), static_cast<off_t>(length));
          if (n < 0)
            return errno;
          if (n == 0)
            break;
          sum.add(buffer.data(), static_cast<std::size_t>(n));
          length += static_cast<std::size_t>(n);
        }
      char head[head_size] = "";
      std::snprintf(head,
                    sizeof head,
                    "%s%u\nlength %zu\nchecksum %016llx\n",
                    title,
                    number,
                    length,
                    static_cast<unsigned long long>(sum.value()));
      errno = 0;
      if (pwrite(file, head, sizeof head, 0) != static_cast<ssize_t>(sizeof head))
        return errno != 0 ? errno : ENOSPC;
      return fsync(file) == 0 ? 0 : errno;
    }


    /** Head, the disk, and its own name for a file that is written; 0 or an error number. */
    int seal(const std::string &part, const std::string &name)
    {
      const int file = open(part.c_str(), O_RDWR | O_CLOEXEC);
      if (file < 0)
        return errno;
      int problem = write_head(file);
      if (close(file) != 0 && problem == 0)
        problem = errno;
      if (problem == 0 && std::rename(part.c_str(), name.c_str()) != 0)
        problem = errno;
      if (problem != 0)
        return problem;
      // that the name is on the disk, too, as far as the file system can do that
      const std::string folder = std::filesystem::path(name).parent_path().string();
      if (const int place = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); place >= 0)
        {
          fsync(place);
          close(place);
        }
      return 0;
    }
  } // namespace


  bool KeySet::operator<(const KeySet &other) const
  {
    return std::tie(counts, checksums) < std::tie(other.counts, other.checksums);
  }


  KeySet KeySet::of(const NodeKeys &keys, const MPI_Comm communicator)
  {
    const unsigned int n_proc = Utilities::MPI::n_mpi_processes(communicator);
    const auto         gather = [&](const std::uint64_t value) {
      std::vector<std::uint64_t> all(n_proc);
      MPI_Allgather(&value, 1, MPI_UINT64_T, all.data(), 1, MPI_UINT64_T, communicator);
      return all;
    };
    return {gather(keys.size()), gather(checksum(keys.data(), keys.size() * sizeof keys[0]))};
  }


  CheckpointWriter::CheckpointWriter(const std::string      &name,
                                     const CheckpointHeader &header,
                                     const MPI_Comm          communicator)
    : name(name)
    , header(header)
    , communicator(communicator)
  {
    if (Utilities::MPI::this_mpi_process(communicator) != 0)
      return;
    set_unfinished_file(name + ".part");
    file = std::make_unique<Hdf5File>(name + ".part", CheckpointFormat::head_size);
  }


  CheckpointWriter::~CheckpointWriter()
  {
    if (!file)
      return;
    file->close();
    std::remove((name + ".part").c_str());
    set_unfinished_file("");
  }


  template <typename number>
  void CheckpointWriter::write(const std::string         &table,
                               const std::vector<number> &own,
                               const std::size_t          n_rows,
                               const std::size_t          n_columns)
  {
    if (file)
      file->begin_table<number>(table, n_rows, n_columns);
    gather_in_turn(own, communicator, [&](const std::vector<number> &rows) {
      if (n_columns > 0)
        file->append(rows.data(), rows.size() / n_columns);
    });
  }


  void CheckpointWriter::take(const std::string &entry, std::vector<double> &values)
  {
    index["numbers"].push_back({entry, values.size()});
    numbers.insert(numbers.end(), values.begin(), values.end());
  }


  void CheckpointWriter::take(const std::string &entry, std::string &value)
  {
    index["texts"].push_back({entry, value.size()});
    texts += value;
  }


  void CheckpointWriter::take_share(const std::string &entry, double &value)
  {
    std::vector<double> all(Utilities::MPI::n_mpi_processes(communicator));
    MPI_Gather(&value, 1, MPI_DOUBLE, all.data(), 1, MPI_DOUBLE, 0, communicator);
    index["shares"].push_back({entry, all.size()});
    shares.insert(shares.end(), all.begin(), all.end());
  }


  unsigned int CheckpointWriter::number_of(const NodeKeys &keys)
  {
    KeySet set            = KeySet::of(keys, communicator);
    const auto [at, made] = sets.emplace(set, static_cast<unsigned int>(sets.size()));
    if (made)
      {
        write("keys/" + std::to_string(at->second),
              keys,
              std::accumulate(set.counts.begin(), set.counts.end(), std::uint64_t(0)),
              1);
        index["keys"].push_back({{"counts", set.counts}, {"checksums", set.checksums}});
      }
    return at->second;
  }


  void CheckpointWriter::take(const std::string &entry,
                              double            *values,
                              const std::size_t  n_per_node,
                              const NodeKeys    &keys)
  {
    const unsigned int set = number_of(keys);
    write("vectors/" + entry,
          std::vector<double>(values, values + n_per_node * keys.size()),
          Utilities::MPI::sum(static_cast<std::uint64_t>(keys.size()), communicator),
          n_per_node);
    index["vectors"][entry] = {{"keys", set}, {"columns", n_per_node}};
  }


  void CheckpointWriter::take(const std::string &entry, KeyedPairs &pairs, const NodeKeys &)
  {
    const std::uint64_t n_own  = pairs.keys.size();
    const std::uint64_t n_rows = Utilities::MPI::sum(n_own, communicator);
    const std::uint64_t n_columns =
      Utilities::MPI::max(n_own > 0 ? pairs.values.size() / n_own : 0, communicator);
    std::vector<std::uint64_t> both;
    both.reserve(2 * n_own);
    for (const KeyedPairs::Key &key : pairs.keys)
      both.insert(both.end(), key.begin(), key.end());
    write("pairs/" + entry + "/keys", both, n_rows, 2);
    write("pairs/" + entry + "/values", pairs.values, n_rows, n_columns);
    index["pairs"][entry] = {{"rows", n_rows}, {"columns", n_columns}};
  }


  int CheckpointWriter::finish()
  {
    using Json  = nlohmann::ordered_json;
    int problem = 0;
    if (file)
      {
        const auto add = [this](const std::string &table, const auto &values) {
          using number = typename std::decay_t<decltype(values)>::value_type;
          file->begin_table<number>(table, values.size(), 1);
          file->append(values.data(), values.size());
        };
        index["program"]   = header.program;
        index["dimension"] = header.dim;
        index["processes"] = header.n_processes;
        index["time"]      = header.time;
        index["wall time"] = header.wall_time;
        index["files"]     = header.files;
        add("scene", header.scene);
        add("index", index.dump(-1, ' ', false, Json::error_handler_t::replace));
        add("numbers", numbers);
        add("texts", texts);
        add("shares", shares);
        problem = file->close();
        if (problem == 0)
          problem = seal(name + ".part", name);
        if (problem != 0)
          std::remove((name + ".part").c_str());
        file.reset();
        set_unfinished_file("");
      }
    return Utilities::MPI::broadcast(communicator, problem, 0);
  }
} // namespace PeriDeal
