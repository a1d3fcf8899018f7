// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /**
   * What nanoflann finds within a distance, in no order: points and the squares of their distances,
   * appended to a list. (The classes that nanoflann brings for this differ between its versions.)
   */
  class PointsWithin
  {
  public:
    using DistanceType = double;
    using IndexType    = unsigned int;

    PointsWithin(const double distance, std::vector<std::pair<unsigned int, double>> &found)
      : square(distance * distance)
      , found(found)
    {}

    // What nanoflann asks.
    std::size_t size() const
    {
      return found.size();
    }

    bool empty() const
    {
      return found.empty();
    }

    bool full() const
    {
      return true;
    }

    double worstDist() const
    {
      return square;
    }

    bool addPoint(const double distance, const unsigned int point)
    {
      if (distance < square)
        found.emplace_back(point, distance);
      return true; // go on
    }

    void sort() {}

  private:
    const double                                  square;
    std::vector<std::pair<unsigned int, double>> &found;
  };
} // namespace PeriDeal
