// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/point.h>
#include <deal.II/base/types.h>

#include <perideal/scene/expression.h>
#include <perideal/scene/lists.h>

#include <array>
#include <string>

namespace PeriDeal
{
  /** The first of the boundary ids that parts have, beyond all that a mesh file can give. */
  constexpr dealii::types::boundary_id first_part_id = 0xf0000000u;

  /**
   * A place for a condition that is no whole side: a part of a side, the nodes of a region, or the
   * node nearest to a point.
   *
   * A part of a side has the area where its formula holds. Regions and points have none: fluxes and
   * tractions there are totals (power, force), shared by the nodes in proportion to their volume.
   */
  struct Part
  {
    enum Kind
    {
      of_side,
      region,
      point
    };

    std::string                name;
    Kind                       kind = of_side;
    dealii::types::boundary_id id   = 0; // of this part: conditions, shares and reactions have it
    dealii::types::boundary_id side = dealii::numbers::invalid_boundary_id; // of_side
    Expression                 inside;  // of_side, region: the part is where this is > 0
    std::array<double, 3>      place{}; // point

    /** Whether a place, on the side for a part of one, belongs to the part; not for points. */
    template <int dim>
    bool holds(const dealii::Point<dim> &p) const
    {
      return inside.value(p) > 0.;
    }

    /** The point. */
    template <int dim>
    dealii::Point<dim> position() const
    {
      return point_of<dim>(place.data());
    }
  };


  /**
   * What stands behind a part's name, `SIDE if FORMULA` of x, y, z, `region FORMULA` or `point X,
   * Y[, Z]`; with the name of its side, for which the part has no number yet.
   * @param where entry, section and part for messages. Throws UserError.
   */
  Part parse_part(const std::string &text,
                  const unsigned int dim,
                  const std::string &where,
                  std::string       &side);
} // namespace PeriDeal
