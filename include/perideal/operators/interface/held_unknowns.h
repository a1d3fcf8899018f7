// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/types.h>

#include <algorithm>
#include <vector>

namespace PeriDeal
{
  /**
   * The owned unknowns of an operator that are not free: those with prescribed values, and those
   * that follow from others. No function is collective.
   */
  class HeldUnknowns
  {
  public:
    /** In ascending order. */
    const std::vector<unsigned int> &held() const
    {
      return not_free;
    }

    /** Set entries that are not free to a value. */
    void mask(Vector &y, const double value = 0.) const
    {
      mask(y, value, 0, y.locally_owned_size());
    }

    /** The same in the rows [begin, end). */
    void mask(Vector &y, const double value, const unsigned int begin, const unsigned int end) const
    {
      for_each(not_free, begin, end, [&](const unsigned int i) { y.local_element(i) = value; });
    }

    /** Sum of y over this process's prescribed unknowns among the rows [begin, end). */
    double sum(const Vector &y, const unsigned int begin, const unsigned int end) const
    {
      double sum = 0.;
      for_each(prescribed_ones, begin, end, [&](const unsigned int i) {
        sum += y.local_element(i);
      });
      return sum;
    }

  protected:
    /** Both ascending; those that are prescribed are part of what is not free. */
    void set_held(std::vector<unsigned int> unknowns, std::vector<unsigned int> prescribed)
    {
      not_free        = std::move(unknowns);
      prescribed_ones = std::move(prescribed);
    }

  private:
    template <typename Visit>
    static void for_each(const std::vector<unsigned int> &list,
                         const unsigned int               begin,
                         const unsigned int               end,
                         const Visit                     &visit)
    {
      for (auto i = std::lower_bound(list.begin(), list.end(), begin); i != list.end() && *i < end;
           ++i)
        visit(*i);
    }

    std::vector<unsigned int> not_free, prescribed_ones;
  };
} // namespace PeriDeal
