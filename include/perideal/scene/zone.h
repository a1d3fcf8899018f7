// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/point.h>

#include <perideal/scene/coupling_control.h>
#include <perideal/scene/crack_geometry.h>

#include <optional>
#include <vector>

namespace PeriDeal
{
  /**
   * The part of the body that peridynamics gets: a test of points, the same on every process. A
   * bond is active if both of its nodes are in the zone.
   *
   * With `cracks: c` the zone is all that lies within c horizons of a crack as it is at some time;
   * cracks grow, so the zone does.
   */
  template <int dim>
  class Zone
  {
  public:
    /** The whole body. */
    Zone() = default;

    Zone(const CouplingControl &control, const double horizon);

    /** Where a formula is greater than 0. */
    explicit Zone(const Expression &formula);

    /** What lies no farther from pieces of cracks, which are still to be set. */
    static Zone near_cracks(const double reach);

    /**
     * Formulas need no values outside of this box, the body's: no part of the zone is looked for
     * there.
     */
    void stay_in(const dealii::BoundingBox<dim> &box)
    {
      body = box;
    }

    /** The cracks from whose pieces the distance counts. */
    void set_cracks(std::vector<CrackPiece<dim>> pieces);

    bool contains(const dealii::Point<dim> &p) const;

    /**
     * How far outside the zone a point lies, at most @p farthest. The distance to the zone of a
     * formula is that in the nearest of a number of directions (24 in 2D, 64 in 3D).
     */
    double distance(const dealii::Point<dim> &p, const double farthest) const;

    /** 1 in the zone, falling linearly to 0 over a width outside of it. */
    double weight(const dealii::Point<dim> &p, const double width_outside) const;

    bool is_everywhere() const
    {
      return kind == ZoneKind::everywhere;
    }

    /** The zone changes with the cracks. */
    bool follows_cracks() const
    {
      return kind == ZoneKind::near_cracks || kind == ZoneKind::adaptive || follows_stretches();
    }

    /** All of the body may join the zone. */
    bool follows_stretches() const
    {
      return kind == ZoneKind::follow;
    }

    /** Distance from a crack that is still in the zone. */
    double width() const
    {
      return reach;
    }

  private:
    double distance_to_formula(const dealii::Point<dim> &p, const double farthest) const;

    ZoneKind                                kind  = ZoneKind::everywhere;
    double                                  reach = 0.;
    Expression                              formula;
    std::optional<dealii::BoundingBox<dim>> body;
    std::vector<dealii::Tensor<1, dim>>     directions; // to look for the zone of a formula
    std::vector<CrackPiece<dim>>            cracks;
    std::vector<dealii::BoundingBox<dim>>   boxes; // around each piece
  };


  /** Distance of a point to a segment (2D) or to a planar polygon (3D), given by its corners. */
  template <int dim>
  double distance_to_piece(const std::vector<dealii::Point<dim>> &corners,
                           const dealii::Point<dim>              &p);
} // namespace PeriDeal
