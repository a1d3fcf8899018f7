// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/exceptions.h>

#include <perideal/bonds/bond_state.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  void BondState::resize(const std::size_t n)
  {
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
    if (mark != parted)
      times.emplace_back(number, time);
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


  std::size_t BondState::count(const Mark mark) const
  {
    return std::count(marks.begin(), marks.end(), mark);
  }


  std::size_t BondState::memory_consumption() const
  {
    return marks.capacity() * sizeof(Mark) + times.capacity() * sizeof(times[0]);
  }
} // namespace PeriDeal
