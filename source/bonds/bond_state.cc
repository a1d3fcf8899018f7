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
    Assert(n >= n_bonds, ExcInternalError());
    const std::size_t n_bytes = (n + 3) / 4;
    if (!marks.empty() && n_bytes > marks.size()) // a list that grows; many never do
      make_room(marks, n_bytes - marks.size());
    marks.resize(n_bytes, 0);
    n_bonds = n;
  }


  void BondState::mark(const std::size_t number, const Mark mark, const double time)
  {
    AssertIndexRange(number, n_bonds);
    Assert(is_whole(number) && mark != whole, ExcInternalError());
    marks[number / 4] |= static_cast<std::uint8_t>(mark << shift(number));
    if (mark == parted && !(time > 0.))
      return;
    if (times.empty() || times.back().second != time)
      times.emplace_back(marked.size(), time);
    make_room(marked, 1);
    marked.push_back(number);
  }


  double BondState::time_of(const std::size_t k) const
  {
    const auto after = std::upper_bound(
      times.begin(),
      times.end(),
      k,
      [](const std::size_t place, const auto &entry) { return place < entry.first; });
    return (after - 1)->second;
  }


  std::vector<std::pair<std::size_t, double>> BondState::marked_since(std::size_t &n_known) const
  {
    std::vector<std::pair<std::size_t, double>> list;
    for (; n_known < marked.size(); ++n_known)
      list.emplace_back(marked[n_known], time_of(n_known));
    return list;
  }


  double BondState::since(const std::size_t number) const
  {
    if (is_whole(number))
      return std::numeric_limits<double>::infinity();
    const auto found = std::find(marked.begin(), marked.end(), number);
    return found == marked.end() ? 0. : time_of(found - marked.begin());
  }


  std::vector<BondState::Kept> BondState::exchange(Archive          &archive,
                                                   const Numbering  &numbering,
                                                   const NodeKeys   &keys,
                                                   const std::size_t n_first)
  {
    KeyedPairs        pairs; // a node, and the number of its bond among its own
    std::vector<Kept> kept;
    if (!archive.loads())
      for (std::size_t k = 0; k < marked.size(); ++k)
        {
          const std::size_t number = marked[k], node = numbering.node_of(number);
          pairs.keys.push_back({keys[node], number - numbering.first_of(node)});
          pairs.values.insert(
            pairs.values.end(),
            {time_of(k), static_cast<double>((*this)[number]), k < n_first ? 1. : 0.});
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
    std::size_t n = 0;
    for (std::size_t number = 0; number < n_bonds; ++number)
      n += (*this)[number] == mark;
    return n;
  }


  std::size_t BondState::memory_consumption() const
  {
    return marks.capacity() + marked.capacity() * sizeof(std::size_t) +
           times.capacity() * sizeof(times[0]);
  }
} // namespace PeriDeal
