// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/point.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /** A hole in the plane of x and y, a circle or a polygon; in three dimensions a bore along z. */
  struct Hole
  {
    std::string                   text;        // as the user wrote it; none: see HoleCells
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

    /** Length of the rim between the two of its points that are nearest to two others. */
    double rim_between(const dealii::Point<2> &a, const dealii::Point<2> &b) const;

    /** Along the rim, from its first point to the one nearest to another. */
    double place_on_rim(const dealii::Point<2> &p) const;

    /** At a place along the rim, which may go around more than once. */
    dealii::Point<2> point_on_rim(const double place) const;

    double rim_length() const;
  };

  /** Cells of a lattice that are removed for a hole: those whose centre lies in it, and joints. */
  struct HoleCells
  {
    std::size_t n_removed = 0;

    /**
     * Where a polygon is thin, cells whose centre lies in it may touch at corners only, or leave
     * gaps. These cells, each a hole without a text, make them share faces from end to end.
     */
    std::vector<Hole> joints;
  };

  /**
   * @param holes all of the body, without the joints of this one
   * @param lower, upper corners of the lattice in the plane of the holes
   */
  HoleCells cells_of_hole(const Hole                        &hole,
                          const std::vector<Hole>           &holes,
                          const dealii::Point<2>            &lower,
                          const dealii::Point<2>            &upper,
                          const std::array<unsigned int, 2> &n_cells);

  /** A face of a cell at a hole, in the plane of the holes. */
  struct RimFace
  {
    dealii::Point<2>     begin, end;
    dealii::Tensor<1, 2> outward; // into the hole, of length 1
  };

  /** A square hole has the radius as half its edge and is turned by the hole angle. */
  enum class HoleShape
  {
    circle,
    square
  };

  /** Of holes: cells of a lattice are missing, or the mesh follows the rims. */
  enum class Rims
  {
    stairs,
    fitted
  };

  /** Of a plate: those of the list `Holes`, and the one that has entries of its own. */
  template <int dim>
  struct Holes
  {
    bool               has_one = false; // that of the four below
    dealii::Point<dim> center;
    double             radius = 0.;
    HoleShape          shape  = HoleShape::circle;
    double             angle  = 0.; // degrees
    std::vector<Hole>  listed;
    Rims               rims = Rims::stairs;

    bool fitted() const
    {
      return rims == Rims::fitted;
    }

    /** All of them, without joints. */
    std::vector<Hole> all() const;

    /** In three dimensions they are bores along z. */
    bool contains(const dealii::Point<dim> &p) const;

    /**
     * From a point to the nearest one, or less (of a square one the distance to the circle around
     * it); the largest number without holes.
     */
    double distance(const dealii::Point<dim> &p) const;

    /**
     * A hole of a lattice has stairs in place of its rim. What of the true rim a face stands for,
     * over the area of the face: what acts on the rim acts by that. Faces around a hole have the
     * area of its rim together, without what of it lies in another hole; those on the rim have 1.
     * @param faces        all that the holes have
     * @param lower, upper corners of the body in the plane of the holes
     */
    std::vector<double> rim_over_faces(const std::vector<RimFace> &faces,
                                       const dealii::Point<2>     &lower,
                                       const dealii::Point<2>     &upper) const;
  };

  /**
   * `circle: x, y, radius`, `rectangle: x, y of the lower left corner, x, y of the upper right one`
   * and `polygon: x, y of its corners`, separated by `;`.
   * @param where entry and section for messages. Throws UserError.
   */
  std::vector<Hole> parse_holes(const std::string &text, const std::string &where);
} // namespace PeriDeal
