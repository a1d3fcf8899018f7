// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/exceptions.h>

#include <perideal/base/make_room.h>
#include <perideal/bonds/bond_state.h>

#include <algorithm>
#include <unordered_map>

namespace PeriDeal
{
  using namespace dealii;

  void BondState::resize(const std::size_t n)
  {
    if (n > marks.size())
      make_room(marks, n - marks.size());
    marks.resize(n, whole);
  }


  std::size_t BondState::size() const
  {
    return marks.size();
  }


  void BondState::mark(const std::size_t number, const Mark mark, const double time)
  {
    AssertIndexRange(number, marks.size());
    Assert(marks[number] == whole && mark != whole, ExcInternalError());
    marks[number] = mark;
    if (mark != parted || time > 0.)
      times.emplace_back(number, time);
  }


  std::vector<std::pair<std::size_t, double>> BondState::marked_since(std::size_t &n_known) const
  {
    const std::size_t first = n_known;
    n_known                 = times.size();
    return {times.begin() + first, times.end()};
  }


  double BondState::since(const std::size_t number) const
  {
    if (is_whole(number))
      return std::numeric_limits<double>::infinity();
    const auto found = std::find_if(times.begin(), times.end(), [number](const auto &entry) {
      return entry.first == number;
    });
    return found == times.end() ? 0. : found->second;
  }


  BondState::Numbering BondState::by_starts(const std::vector<std::size_t> &starts)
  {
    return {[&starts](const std::size_t number) -> std::size_t {
              return std::upper_bound(starts.begin(), starts.end(), number) - starts.begin() - 1;
            },
            [&starts](const std::size_t node) { return starts[node]; },
            [&starts]() { return starts.back(); }};
  }


  std::vector<BondState::Kept> BondState::exchange(Archive          &archive,
                                                   const Numbering  &numbering,
                                                   const NodeKeys   &keys,
                                                   const std::size_t n_first)
  {
    KeyedPairs        pairs; // a node, and the number of its bond among its own
    std::vector<Kept> kept;
    if (!archive.loads())
      for (std::size_t k = 0; k < times.size(); ++k)
        {
          const auto [number, time] = times[k];
          const std::size_t node    = numbering.node_of(number);
          pairs.keys.push_back({keys[node], number - numbering.first_of(node)});
          pairs.values.insert(pairs.values.end(),
                              {time, static_cast<double>(marks[number]), k < n_first ? 1. : 0.});
        }
    archive.exchange("bonds", pairs, keys);
    if (!archive.loads() || pairs.keys.empty())
      return kept;
    std::unordered_map<std::uint64_t, std::size_t> node_of;
    for (std::size_t node = 0; node < keys.size(); ++node)
      node_of[keys[node]] = node;
    for (std::size_t k = 0; k < pairs.keys.size(); ++k)
      kept.push_back({numbering.first_of(node_of.at(pairs.keys[k][0])) + pairs.keys[k][1],
                      static_cast<Mark>(pairs.values[3 * k + 1]),
                      pairs.values[3 * k],
                      pairs.values[3 * k + 2] > 0.});
    resize(numbering.n_bonds());
    std::sort(kept.begin(), kept.end(), [](const Kept &a, const Kept &b) {
      return a.number < b.number;
    });
    return kept;
  }


  std::size_t BondState::count(const Mark mark) const
  {
    return std::count(marks.begin(), marks.end(), mark);
  }


  std::size_t BondState::memory_consumption() const
  {
    return marks.capacity() * sizeof(Mark) + times.capacity() * sizeof(times[0]);
  }
} // namespace PeriDeal
