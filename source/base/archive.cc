// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/archive.h>
#include <perideal/base/user_error.h>

#include <cstring>
#include <numeric>
#include <set>

namespace PeriDeal
{
  using namespace dealii;

  Archive::Part::Part(Archive &archive, const std::string &name)
    : archive(archive)
  {
    archive.parts.push_back(name);
  }


  Archive::Part::~Part()
  {
    archive.parts.pop_back();
  }


  std::string Archive::full_name(const std::string &name) const
  {
    std::string text;
    for (const std::string &part : parts)
      text += part + "/";
    return text + name;
  }


  void Archive::exchange(const std::string &name, std::vector<double> &values)
  {
    take(full_name(name), values);
  }


  void Archive::exchange(const std::string &name, double &value)
  {
    std::vector<double> one{value};
    exchange(name, one);
    value = one.at(0);
  }


  void Archive::exchange(const std::string &name, unsigned long long &value)
  {
    double bits; // all 64 of them
    static_assert(sizeof bits == sizeof value, "Counts are kept in the place of numbers.");
    std::memcpy(&bits, &value, sizeof value);
    exchange(name, bits);
    std::memcpy(&value, &bits, sizeof value);
  }


  void Archive::exchange(const std::string &name, unsigned int &value)
  {
    unsigned long long number = value;
    exchange(name, number);
    value = static_cast<unsigned int>(number);
  }


  void Archive::exchange(const std::string &name, bool &value)
  {
    unsigned long long number = value ? 1 : 0;
    exchange(name, number);
    value = number != 0;
  }


  void Archive::exchange(const std::string &name, std::string &value)
  {
    take(full_name(name), value);
  }


  void Archive::exchange_share(const std::string &name, double &value)
  {
    take_share(full_name(name), value);
  }


  void Archive::exchange(const std::string &name, Vector &v, const NodeKeys &keys)
  {
    // A process without nodes does not know how many values others have for each.
    const std::size_t n_nodes =
      Utilities::MPI::sum(static_cast<unsigned long long>(keys.size()), v.get_mpi_communicator());
    const std::size_t n_per_node = n_nodes > 0 ? v.size() / n_nodes : 0;
    AssertDimension(n_per_node * keys.size(), v.locally_owned_size());
    take(full_name(name), v.begin(), n_per_node, keys);
  }


  void Archive::exchange(const std::string &name, KeyedPairs &pairs, const NodeKeys &keys)
  {
    take(full_name(name), pairs, keys);
  }


  MemoryArchive::MemoryArchive(const MPI_Comm communicator)
    : communicator(communicator)
    , is_loading(false)
  {}


  MemoryArchive::MemoryArchive(const MemoryArchive &saved, const MPI_Comm communicator)
    : communicator(communicator)
    , is_loading(true)
    , numbers(saved.numbers)
    , texts(saved.texts)
    , shares(saved.shares)
    , vectors(saved.vectors)
    , all_pairs(saved.all_pairs)
  {}


  template <typename T>
  T &MemoryArchive::entry(std::map<std::string, T> &entries, const std::string &name) const
  {
    AssertThrow(!is_loading || entries.count(name) == 1,
                UserError("The saved state has no '" + name +
                          "': it is that of another scene or another version of PeriDeal."));
    return entries[name];
  }


  void MemoryArchive::take(const std::string &name, std::vector<double> &values)
  {
    std::vector<double> &kept    = entry(numbers, name);
    (is_loading ? values : kept) = is_loading ? kept : values;
  }


  void MemoryArchive::take(const std::string &name, std::string &value)
  {
    std::string &kept           = entry(texts, name);
    (is_loading ? value : kept) = is_loading ? kept : value;
  }


  void MemoryArchive::take_share(const std::string &name, double &value)
  {
    std::vector<double> &kept = entry(shares, name);
    if (!is_loading)
      {
        kept = Utilities::MPI::all_gather(communicator, value);
        return;
      }
    const unsigned int rank = Utilities::MPI::this_mpi_process(communicator);
    if (kept.size() == Utilities::MPI::n_mpi_processes(communicator))
      value = kept[rank];
    else
      value = rank == 0 ? std::accumulate(kept.begin(), kept.end(), 0.) : 0.;
  }


  void MemoryArchive::take(const std::string &name,
                           double            *values,
                           const std::size_t  n_per_node,
                           const NodeKeys    &keys)
  {
    NodeValues &kept = entry(vectors, name);
    if (!is_loading)
      {
        kept.clear();
        const std::vector<double> owned(values, values + keys.size() * n_per_node);
        const auto                all_keys   = Utilities::MPI::all_gather(communicator, keys);
        const auto                all_values = Utilities::MPI::all_gather(communicator, owned);
        for (std::size_t process = 0; process < all_keys.size(); ++process)
          for (std::size_t i = 0; i < all_keys[process].size(); ++i)
            {
              const double *of_node = all_values[process].data() + i * n_per_node;
              const bool    is_new =
                kept
                  .emplace(all_keys[process][i], std::vector<double>(of_node, of_node + n_per_node))
                  .second;
              AssertThrow(is_new, ExcMessage("Two nodes have the same key."));
            }
        return;
      }
    bool fits = kept.size() == Utilities::MPI::sum(keys.size(), communicator);
    for (std::size_t i = 0; i < keys.size() && fits; ++i)
      {
        const auto found = kept.find(keys[i]);
        fits             = found != kept.end() && found->second.size() == n_per_node;
        if (fits)
          std::copy(found->second.begin(), found->second.end(), values + i * n_per_node);
      }
    throw_on_all_if_any(
      communicator,
      fits ? "" : "The saved '" + name + "' belongs to other nodes: the mesh is another one.");
  }


  void MemoryArchive::take(const std::string &name, KeyedPairs &pairs, const NodeKeys &keys)
  {
    KeyedPairs &kept = entry(all_pairs, name);
    if (!is_loading)
      {
        kept = KeyedPairs();
        for (const auto &some : Utilities::MPI::all_gather(communicator, pairs.keys))
          kept.keys.insert(kept.keys.end(), some.begin(), some.end());
        for (const auto &some : Utilities::MPI::all_gather(communicator, pairs.values))
          kept.values.insert(kept.values.end(), some.begin(), some.end());
        return;
      }
    const std::set<std::uint64_t> mine(keys.begin(), keys.end());
    const std::size_t             n_pairs = kept.keys.size();
    const std::size_t             n       = n_pairs > 0 ? kept.values.size() / n_pairs : 0;
    pairs                                 = KeyedPairs();
    for (std::size_t k = 0; k < n_pairs; ++k)
      if (mine.count(kept.keys[k][0]) > 0)
        {
          pairs.keys.push_back(kept.keys[k]);
          const auto first = kept.values.begin() + k * n;
          pairs.values.insert(pairs.values.end(), first, first + n);
        }
  }
} // namespace PeriDeal
