// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/archive.h>
#include <perideal/base/user_error.h>

#include <numeric>

namespace PeriDeal
{
  void Archive::exchange(const std::string &name, bool &value)
  {
    unsigned long long number = value ? 1 : 0;
    exchange(name, number);
    value = number != 0;
  }


  MemoryArchive::MemoryArchive(const MPI_Comm communicator)
    : communicator(communicator)
    , is_loading(false)
  {}


  MemoryArchive::MemoryArchive(const MemoryArchive &saved, const MPI_Comm communicator)
    : communicator(communicator)
    , is_loading(true)
    , numbers(saved.numbers)
    , counts(saved.counts)
    , shares(saved.shares)
    , vectors(saved.vectors)
  {}


  bool MemoryArchive::loads() const
  {
    return is_loading;
  }


  template <typename T>
  T &MemoryArchive::entry(std::map<std::string, T> &entries, const std::string &name) const
  {
    AssertThrow(!is_loading || entries.count(name) == 1,
                UserError("The saved state has no '" + name +
                          "': it is that of another scene or another version of PeriDeal."));
    return entries[name];
  }


  void MemoryArchive::exchange(const std::string &name, double &value)
  {
    double &kept                = entry(numbers, name);
    (is_loading ? value : kept) = is_loading ? kept : value;
  }


  void MemoryArchive::exchange(const std::string &name, unsigned long long &value)
  {
    unsigned long long &kept    = entry(counts, name);
    (is_loading ? value : kept) = is_loading ? kept : value;
  }


  void MemoryArchive::exchange_share(const std::string &name, double &value)
  {
    std::vector<double> &kept = entry(shares, name);
    if (!is_loading)
      {
        kept = dealii::Utilities::MPI::all_gather(communicator, value);
        return;
      }
    const unsigned int rank = dealii::Utilities::MPI::this_mpi_process(communicator);
    if (kept.size() == dealii::Utilities::MPI::n_mpi_processes(communicator))
      value = kept[rank];
    else
      value = rank == 0 ? std::accumulate(kept.begin(), kept.end(), 0.) : 0.;
  }


  void MemoryArchive::exchange(const std::string &name, Vector &v, const UnknownKeys &keys)
  {
    AssertDimension(keys.size(), v.locally_owned_size());
    Values &kept = entry(vectors, name);
    if (!is_loading)
      {
        const std::vector<double> owned(v.begin(), v.begin() + v.locally_owned_size());
        const auto                all_keys = dealii::Utilities::MPI::all_gather(communicator, keys);
        const auto all_values = dealii::Utilities::MPI::all_gather(communicator, owned);
        for (std::size_t process = 0; process < all_keys.size(); ++process)
          for (std::size_t i = 0; i < all_keys[process].size(); ++i)
            {
              const bool is_new = kept.emplace(all_keys[process][i], all_values[process][i]).second;
              AssertThrow(is_new, dealii::ExcMessage("Two unknowns have the same key."));
            }
        return;
      }
    bool fits = kept.size() == v.size();
    for (std::size_t i = 0; i < keys.size() && fits; ++i)
      {
        const auto found = kept.find(keys[i]);
        fits             = found != kept.end();
        if (fits)
          v.local_element(i) = found->second;
      }
    throw_on_all_if_any(
      communicator,
      fits ? "" : "The saved '" + name + "' belongs to other nodes: the mesh is another one.");
  }
} // namespace PeriDeal
