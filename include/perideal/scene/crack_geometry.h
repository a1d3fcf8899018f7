// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/point.h>

#include <perideal/scene/crack_tips.h>

#include <optional>
#include <vector>

namespace PeriDeal
{
  /** Twice the area of a planar polygon times its right-hand normal. */
  dealii::Tensor<1, 3> doubled_area_vector(const std::vector<dealii::Point<3>> &corners);


  /**
   * One straight piece of a crack: a segment in 2D, a planar polygon in 3D. Pure geometry.
   *
   * The normal points to the crack's *left* side: in 2D the direction from start to end turned by
   * +90 degrees, in 3D the polygon's right-hand normal. A point exactly on the crack (within 1e-10
   * of the crack's size) belongs to that side, so that a crack through a row of nodes acts like the
   * same crack moved by an infinitesimal distance against its normal. A strict crossing test would
   * let such nodes keep all of their bonds, and heat would leak through the crack.
   */
  template <int dim>
  class CrackGeometry
  {
  public:
    /** @param corners two points in 2D; three or more corners of a planar polygon in 3D. */
    explicit CrackGeometry(const std::vector<dealii::Point<dim>> &corners);

    /**
     * Whether the straight line between two points crosses the crack. Symmetric in its arguments.
     * What passes through a tip (in 3D an edge), or within 1e-7 of the crack's size, does not:
     * mirror images of a bond about the crack or through a tip are treated alike. Ends on another
     * crack or on the surface of the body are no tips; there it does.
     */
    bool separates(const dealii::Point<dim> &a, const dealii::Point<dim> &b) const;

    /**
     * The part of a bond between two points that the crack cuts, if it does so in part near its
     * ends in 2D: clamp(s/w + 1/2, 0, 1), where the bond passes the line of the crack a distance s
     * behind an end. Ends that are closed, and those of other dimensions, cut bonds as a whole
     * (separates()).
     * @param width w
     */
    double cut_part(const dealii::Point<dim> &a,
                    const dealii::Point<dim> &b,
                    const double              width) const;

    /**
     * Signed distance to the crack's line or plane, positive on the left side; points on it count
     * as positive.
     */
    double signed_distance(const dealii::Point<dim> &p) const;

    /**
     * Whether the point lies on the crack itself, tips included (not only on its line or plane).
     */
    bool contains(const dealii::Point<dim> &p) const;

    /**
     * Whether a point near the crack's line or plane lies beside the crack itself, tips included.
     */
    bool covers(const dealii::Point<dim> &p) const;

    /**
     * Whether the end (3D: the edge) of the crack that is nearest to a point on its line or plane
     * is closed.
     */
    bool is_closed_near(const dealii::Point<dim> &p) const;

    /**
     * Whether the ball of the given radius about p meets the crack's bounding box and its line or
     * plane: a quick test to skip far nodes.
     */
    bool is_near(const dealii::Point<dim> &p, const double radius) const;

    const dealii::Tensor<1, dim> &normal() const
    {
      return unit_normal;
    }

    /** Length in 2D, area in 3D. */
    double measure() const
    {
      return content;
    }

    const std::vector<dealii::Point<dim>> &corners() const
    {
      return corner_points;
    }

    /**
     * Close the ends (3D: the edges) that lie on another crack, so that cracks that meet leave no
     * gap: each acts from an infinitesimal distance beside its line, and bonds through the very
     * joint would else slip through between them.
     */
    void close_joints(const CrackGeometry &other);

    /** Close an end (3D: the edge from this corner to the next). */
    void close(const unsigned int end);

    unsigned int crack = 0; // that this is a piece of

  private:
    /** Where the line between two points on both sides crosses the crack's line or plane. */
    std::optional<dealii::Point<dim>> crossing(const dealii::Point<dim> &a,
                                               const dealii::Point<dim> &b) const;

    bool plane_point_inside(const dealii::Point<dim> &p, const bool with_tips) const;

    std::vector<dealii::Point<dim>> corner_points;
    dealii::Point<dim>              lowest, highest;
    dealii::Tensor<1, dim>          unit_normal, first_axis, second_axis;
    double                          size = 0., tolerance = 0., content = 0.;
    std::vector<bool>               closed; // ends (2D) or edges (3D)
  };

  /** The pieces of the cracks of a scene in the given order, with closed joints. */
  template <int dim>
  std::vector<CrackGeometry<dim>> make_crack_geometries(const std::vector<CrackPiece<dim>> &pieces);

  /** The same with no other ends closed than joints. */
  template <int dim>
  std::vector<CrackGeometry<dim>> make_open_geometries(std::vector<CrackPiece<dim>> pieces);
} // namespace PeriDeal
