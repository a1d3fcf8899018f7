// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/point.h>

#include <nanoflann.hpp>

#include <cstddef>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /**
   * What nanoflann finds within a distance: points and the squares of their distances, appended to
   * a list. (The classes that nanoflann brings for this differ between its versions.)
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


  /** A k-d tree over n points, which stay where they are: position(i), a reference. */
  template <int dim, typename Position>
  class PointTree
  {
  public:
    PointTree(const std::size_t n, const Position &position)
      : n(n)
      , position(position)
      , index(dim, *this, nanoflann::KDTreeSingleIndexAdaptorParams(16))
    {
      index.buildIndex();
    }

    PointTree(const PointTree &) = delete;

    /** Append the points within a distance, in no order, and the squares of their distances. */
    void find(const dealii::Point<dim>                     &p,
              const double                                  distance,
              std::vector<std::pair<unsigned int, double>> &found) const
    {
      PointsWithin result(distance, found);
      index.radiusSearchCustomCallback(p.begin_raw(), result);
    }

    // What nanoflann asks.
    std::size_t kdtree_get_point_count() const
    {
      return n;
    }

    double kdtree_get_pt(const std::size_t i, const std::size_t d) const
    {
      return position(i)[d];
    }

    template <typename BoundingBox>
    bool kdtree_get_bbox(BoundingBox &) const
    {
      return false;
    }

  private:
    const std::size_t n;
    const Position    position;
    nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, PointTree>,
                                        PointTree,
                                        dim,
                                        unsigned int>
      index;
  };
} // namespace PeriDeal
