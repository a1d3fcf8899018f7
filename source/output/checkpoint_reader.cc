// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/user_error.h>
#include <perideal/output/checkpoint_file.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <sstream>
#include <unordered_map>
#include <unordered_set>

#include "checksum.h"
#include "gather_in_turn.h"
#include "hdf5_file.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    std::size_t rows_before(const std::vector<std::uint64_t> &counts, const unsigned int process)
    {
      return std::accumulate(counts.begin(), counts.begin() + process, std::size_t(0));
    }


    /** The checksum of all behind the head. */
    std::uint64_t checksum_of_rest(std::ifstream &file)
    {
      std::vector<char> buffer(std::size_t(1) << 20);
      Checksum          sum;
      file.seekg(CheckpointFormat::head_size);
      while (file.read(buffer.data(), static_cast<std::streamsize>(buffer.size())) ||
             file.gcount() > 0)
        sum.add(buffer.data(), static_cast<std::size_t>(file.gcount()));
      return sum.value();
    }
  } // namespace


  std::string fault_of_checkpoint(const std::string &name)
  {
    using namespace CheckpointFormat;
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(name, ignored))
      return "is no file";
    errno = 0;
    std::ifstream file(name, std::ios::binary);
    if (!file)
      return "cannot be read (" + std::string(std::strerror(errno)) + ")";
    std::string head(head_size, '\0');
    file.read(head.data(), static_cast<std::streamsize>(head.size()));
    if (head.compare(0, std::strlen(title), title) != 0)
      return "is no checkpoint of PeriDeal";
    std::istringstream words(head.substr(std::strlen(title)));
    unsigned int       format = 0;
    std::uintmax_t     length = 0;
    std::uint64_t      sum    = 0;
    std::string        word_length, word_sum;
    words >> format;
    if (words && format != number)
      return "has format " + std::to_string(format) + "; this version of PeriDeal reads format " +
             std::to_string(number);
    words >> word_length >> length >> word_sum >> std::hex >> sum;
    if (!words)
      return "has a damaged head";
    const std::uintmax_t found = std::filesystem::file_size(name, ignored);
    if (found < length)
      return "is cut short: it has " + std::to_string(found) + " of " + std::to_string(length) +
             " bytes";
    if (found > length || checksum_of_rest(file) != sum)
      return "is damaged: its checksum is another";
    return "";
  }


  CheckpointReader::CheckpointReader(const std::string &name, const MPI_Comm communicator)
    : name(name)
    , communicator(communicator)
  {
    std::string         text;
    std::vector<double> all_numbers, all_shares;
    std::string         all_texts;
    bool                good = true;
    if (Utilities::MPI::this_mpi_process(communicator) == 0)
      {
        file = std::make_unique<Hdf5Input>(name);
        good = file->read_all("index", text) && file->read_all("scene", of_run.scene) &&
               file->read_all("numbers", all_numbers) && file->read_all("texts", all_texts) &&
               file->read_all("shares", all_shares);
      }
    check(good, "cannot be read");
    broadcast_all(text, communicator);
    broadcast_all(of_run.scene, communicator);
    broadcast_all(all_numbers, communicator);
    broadcast_all(all_texts, communicator);
    broadcast_all(all_shares, communicator);
    try
      {
        index              = Json::parse(text);
        of_run.program     = index.at("program").get<std::string>();
        of_run.dim         = index.at("dimension").get<unsigned int>();
        of_run.n_processes = index.at("processes").get<unsigned int>();
        of_run.time        = index.at("time").get<double>();
        of_run.wall_time   = index.at("wall time").get<double>();
        of_run.files       = index.value("files", std::map<std::string, std::string>());
        const auto split   = [this](const char *kind, const auto &all, auto &parts) {
          std::size_t done = 0;
          for (const Json &part : index.value(kind, Json::array()))
            {
              const std::size_t n = part.at(1).get<std::size_t>();
              using Part          = std::decay_t<decltype(all)>;
              parts[part.at(0).get<std::string>()] =
                Part(all.begin() + done, all.begin() + done + n);
              done += n;
            }
        };
        split("numbers", all_numbers, numbers);
        split("shares", all_shares, shares);
        split("texts", all_texts, texts);
        for (const Json &set : index.value("keys", Json::array()))
          sets.push_back({set.at("counts").get<std::vector<std::uint64_t>>(),
                          set.at("checksums").get<std::vector<std::uint64_t>>()});
      }
    catch (const Json::exception &)
      {
        good = false;
      }
    check(good, "has an index that cannot be understood");
  }


  CheckpointReader::~CheckpointReader() = default;


  void CheckpointReader::check(const bool good, const std::string &problem) const
  {
    throw_on_all_if_any(communicator, good ? "" : "The checkpoint '" + name + "' " + problem + ".");
  }


  namespace
  {
    template <typename T>
    const T &found(const std::map<std::string, T> &entries, const std::string &name)
    {
      const auto at = entries.find(name);
      AssertThrow(at != entries.end(),
                  UserError("The checkpoint has no '" + name +
                            "': it is that of another scene or another version of PeriDeal."));
      return at->second;
    }
  } // namespace


  void CheckpointReader::take(const std::string &entry_name, std::vector<double> &values)
  {
    values = found(numbers, entry_name);
  }


  void CheckpointReader::take(const std::string &entry_name, std::string &value)
  {
    value = found(texts, entry_name);
  }


  void CheckpointReader::take_share(const std::string &entry_name, double &value)
  {
    const std::vector<double> &all  = found(shares, entry_name);
    const unsigned int         rank = Utilities::MPI::this_mpi_process(communicator);
    if (all.size() == Utilities::MPI::n_mpi_processes(communicator))
      value = all[rank];
    else
      value = rank == 0 ? std::accumulate(all.begin(), all.end(), 0.) : 0.;
  }


  const CheckpointReader::Json &CheckpointReader::entry(const std::string &kind,
                                                        const std::string &entry_name) const
  {
    AssertThrow(index.contains(kind) && index[kind].contains(entry_name),
                UserError("The checkpoint has no '" + entry_name +
                          "': it is that of another scene or another version of PeriDeal."));
    return index[kind][entry_name];
  }


  template <typename number, typename Use>
  void CheckpointReader::for_each_block(const std::string &table,
                                        const std::size_t  n_rows,
                                        const std::size_t  n_columns,
                                        const Use         &use) const
  {
    constexpr std::size_t many = std::size_t(1) << 20; // rows
    std::vector<number>   block;
    if (n_columns == 0)
      return;
    for (std::size_t first = 0; first < n_rows; first += many)
      {
        const std::size_t n    = std::min(many, n_rows - first);
        bool              good = true;
        block.resize(n * n_columns);
        if (file)
          good = file->read(table, first, n, n_columns, block.data());
        check(good, "cannot be read");
        broadcast_all(block, communicator);
        use(first, block);
      }
  }


  const CheckpointReader::Places &CheckpointReader::places_of(const unsigned int number,
                                                              const NodeKeys    &keys,
                                                              const KeySet      &of_keys)
  {
    const auto [at, is_new] = places.try_emplace({number, of_keys});
    Places &list            = at->second;
    if (!is_new)
      return list;
    std::unordered_map<std::uint64_t, std::uint64_t> own;
    own.reserve(keys.size());
    for (std::size_t k = 0; k < keys.size(); ++k)
      own.emplace(keys[k], k);
    const std::size_t n_rows = rows_before(sets[number].counts, sets[number].counts.size());
    for_each_block<std::uint64_t>("keys/" + std::to_string(number),
                                  n_rows,
                                  1,
                                  [&](const std::size_t first, const NodeKeys &block) {
                                    for (std::size_t k = 0; k < block.size(); ++k)
                                      if (const auto target = own.find(block[k]);
                                          target != own.end())
                                        {
                                          list.rows.push_back(first + k);
                                          list.targets.push_back(target->second);
                                        }
                                  });
    const bool all_found = list.rows.size() == keys.size() && own.size() == keys.size();
    list.fit             = Utilities::MPI::min(all_found ? 1 : 0, communicator) == 1 &&
               n_rows == rows_before(of_keys.counts, of_keys.counts.size());
    return list;
  }


  void CheckpointReader::take(const std::string &entry_name,
                              double            *values,
                              const std::size_t  n_per_node,
                              const NodeKeys    &keys)
  {
    const Json        &about   = entry("vectors", entry_name);
    const unsigned int number  = about.at("keys").get<unsigned int>();
    const KeySet      &saved   = sets.at(number);
    const KeySet       wanted  = KeySet::of(keys, communicator);
    const std::string  table   = "vectors/" + entry_name;
    const bool         is_wide = about.at("columns").get<std::size_t>() == n_per_node;
    if (is_wide && !(saved < wanted) && !(wanted < saved))
      {
        bool good = true;
        scatter_in_turn(values,
                        n_per_node * keys.size(),
                        communicator,
                        [&](const unsigned int process, double *target, const std::size_t) {
                          good &= file->read(table,
                                             rows_before(saved.counts, process),
                                             saved.counts[process],
                                             n_per_node,
                                             target);
                        });
        return check(good, "cannot be read");
      }
    const Places &places = places_of(number, keys, wanted);
    AssertThrow(
      is_wide && places.fit,
      UserError("The saved '" + entry_name + "' belongs to other nodes: the mesh is another one."));
    std::size_t next = 0;
    for_each_block<double>(table,
                           rows_before(saved.counts, saved.counts.size()),
                           n_per_node,
                           [&](const std::size_t first, const std::vector<double> &block) {
                             const std::size_t end = first + block.size() / n_per_node;
                             for (; next < places.rows.size() && places.rows[next] < end; ++next)
                               std::copy_n(block.data() + (places.rows[next] - first) * n_per_node,
                                           n_per_node,
                                           values + places.targets[next] * n_per_node);
                           });
  }


  void CheckpointReader::take(const std::string &entry_name,
                              KeyedPairs        &pairs,
                              const NodeKeys    &keys)
  {
    const Json                             &about     = entry("pairs", entry_name);
    const std::size_t                       n_columns = about.at("columns").get<std::size_t>();
    const std::size_t                       n_rows    = about.at("rows").get<std::size_t>();
    const std::unordered_set<std::uint64_t> own(keys.begin(), keys.end());
    std::vector<std::uint64_t>              rows;
    pairs = KeyedPairs();
    for_each_block<std::uint64_t>("pairs/" + entry_name + "/keys",
                                  n_rows,
                                  2,
                                  [&](const std::size_t first, const NodeKeys &block) {
                                    for (std::size_t k = 0; 2 * k < block.size(); ++k)
                                      if (own.count(block[2 * k]) > 0)
                                        {
                                          rows.push_back(first + k);
                                          pairs.keys.push_back({{block[2 * k], block[2 * k + 1]}});
                                        }
                                  });
    std::size_t next = 0;
    for_each_block<double>("pairs/" + entry_name + "/values",
                           n_rows,
                           n_columns,
                           [&](const std::size_t first, const std::vector<double> &block) {
                             const std::size_t end = first + block.size() / n_columns;
                             for (; next < rows.size() && rows[next] < end; ++next)
                               {
                                 const double *row =
                                   block.data() + (rows[next] - first) * n_columns;
                                 pairs.values.insert(pairs.values.end(), row, row + n_columns);
                               }
                           });
  }
} // namespace PeriDeal
