// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/point.h>

#include <string>
#include <vector>

namespace PeriDeal
{
  /** A hole in the plane of x and y, a circle or a polygon; in three dimensions a bore along z. */
  struct Hole
  {
    std::string                   text;        // as the user wrote it
    dealii::Point<2>              center;      // of a circle
    double                        radius = 0.; // 0 for a polygon
    std::vector<dealii::Point<2>> corners;     // of a polygon

    /** Whether a point lies inside, not on the rim of a circle. */
    bool contains(const dealii::Point<2> &p) const;

    /** From a point to the rim; negative inside. */
    double distance(const dealii::Point<2> &p) const;

    /** The smallest and the largest coordinates. */
    std::pair<dealii::Point<2>, dealii::Point<2>> box() const;

    double area() const;
  };

  /**
   * `circle: x, y, radius`, `rectangle: x, y of the lower left corner, x, y of the upper right one`
   * and `polygon: x, y of its corners`, separated by `;`.
   * @param where entry and section for messages. Throws UserError.
   */
  std::vector<Hole> parse_holes(const std::string &text, const std::string &where);
} // namespace PeriDeal
