// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/bounding_box.h>

#include <perideal/base/instantiate.h>
#include <perideal/scene/crack_geometry.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** Fraction of a crack's size within which a point counts as lying on it. */
    constexpr double on_crack = 1e-10;

    /**
     * Fraction of a crack's size: closer to an end counts as being at it. Far more than on_crack,
     * so that bonds through the very tip are treated alike whichever way they lean and on whichever
     * side of the nodes the crack runs.
     */
    constexpr double edge = 1e-7;
  } // namespace


  Tensor<1, 3> doubled_area_vector(const std::vector<Point<3>> &corners)
  {
    Tensor<1, 3> sum;
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
      sum += cross_product_3d(corners[i] - corners[0], corners[i + 1] - corners[0]);
    return sum;
  }


  template <int dim>
  CrackGeometry<dim>::CrackGeometry(const std::vector<Point<dim>> &corners)
    : corner_points(corners)
  {
    std::tie(lowest, highest) = BoundingBox<dim>(corners).get_boundary_points();
    size                      = lowest.distance(highest);
    tolerance                 = std::max(on_crack * size,
                         16. * std::numeric_limits<double>::epsilon() *
                           std::max(lowest.norm(), highest.norm()));
    closed.assign(corners.size(), false);
    first_axis = corners[1] - corners[0];
    first_axis /= first_axis.norm();
    if constexpr (dim == 2)
      {
        content        = corners[0].distance(corners[1]);
        unit_normal[0] = -first_axis[1];
        unit_normal[1] = first_axis[0];
      }
    else if constexpr (dim == 3)
      {
        unit_normal = doubled_area_vector(corners);
        content     = 0.5 * unit_normal.norm();
        unit_normal /= unit_normal.norm();
        second_axis = cross_product_3d(unit_normal, first_axis);
      }
  }


  template <int dim>
  double CrackGeometry<dim>::signed_distance(const Point<dim> &p) const
  {
    return (p - corner_points[0]) * unit_normal + tolerance;
  }


  template <int dim>
  bool CrackGeometry<dim>::plane_point_inside(const Point<dim> &p, const bool with_tips) const
  {
    const Tensor<1, dim> from_start = p - corner_points[0];
    const double         margin     = edge * size;
    if constexpr (dim == 2)
      {
        const double along = from_start * first_axis;
        return along >= (with_tips || closed[0] ? -margin : margin) &&
               along <= content + (with_tips || closed[1] ? margin : -margin);
      }
    else if constexpr (dim == 3)
      {
        // Crossing number of a ray along the first axis; what is within the margin of an edge lies
        // at it.
        const double x = from_start * first_axis, y = from_start * second_axis;
        bool         inside = false, at_closed = false, at_tip = false;
        for (std::size_t i = 0; i < corner_points.size(); ++i)
          {
            const Tensor<1, dim> a = corner_points[i] - corner_points[0],
                                 b =
                                   corner_points[(i + 1) % corner_points.size()] - corner_points[0];
            const double ax = a * first_axis, ay = a * second_axis, bx = b * first_axis,
                         by = b * second_axis, ex = bx - ax, ey = by - ay;
            const double length_square = ex * ex + ey * ey;
            const double along =
              std::clamp(((x - ax) * ex + (y - ay) * ey) / length_square, 0., 1.);
            if (std::hypot(ax + along * ex - x, ay + along * ey - y) <= margin)
              (with_tips || closed[i] ? at_closed : at_tip) = true;
            if ((ay > y) != (by > y) && x < ax + (y - ay) / ey * ex)
              inside = !inside;
          }
        return at_closed || (inside && !at_tip);
      }
    else
      return false;
  }


  template <int dim>
  std::optional<Point<dim>> CrackGeometry<dim>::crossing(const Point<dim> &a,
                                                         const Point<dim> &b) const
  {
    const double at_a = signed_distance(a), at_b = signed_distance(b);
    if ((at_a > 0.) == (at_b > 0.))
      return {};
    // Always computed from the positive end, so that both ends of a bond come to the same answer.
    return at_a > 0. ? a + at_a / (at_a - at_b) * (b - a) : b + at_b / (at_b - at_a) * (a - b);
  }


  template <int dim>
  bool CrackGeometry<dim>::separates(const Point<dim> &a, const Point<dim> &b) const
  {
    const auto place = crossing(a, b);
    return place && plane_point_inside(*place, false);
  }


  template <int dim>
  double CrackGeometry<dim>::cut_part(const Point<dim> &a,
                                      const Point<dim> &b,
                                      const double      width) const
  {
    if (dim != 2)
      return separates(a, b) ? 1. : 0.;
    const auto place = crossing(a, b);
    if (!place)
      return 0.;
    const double along = (*place - corner_points[0]) * first_axis, margin = edge * size;
    double       part = 1.;
    for (unsigned int e = 0; e < 2; ++e)
      {
        const double behind = e == 0 ? along : content - along;
        part                = std::min(part,
                        closed[e] ? (behind >= -margin ? 1. : 0.) :
                                                   std::clamp(behind / width + 0.5, 0., 1.));
      }
    return part;
  }


  template <int dim>
  bool CrackGeometry<dim>::contains(const Point<dim> &p) const
  {
    const double distance = (p - corner_points[0]) * unit_normal;
    return std::abs(distance) <= tolerance && plane_point_inside(p, true);
  }


  template <int dim>
  bool CrackGeometry<dim>::covers(const Point<dim> &p) const
  {
    return plane_point_inside(p, true);
  }


  template <int dim>
  bool CrackGeometry<dim>::is_closed_near(const Point<dim> &p) const
  {
    if (dim == 2)
      return closed[(p - corner_points[0]) * first_axis > 0.5 * content ? 1 : 0];
    std::size_t nearest  = 0;
    double      distance = std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < corner_points.size(); ++i)
      {
        const Tensor<1, dim> edge =
          corner_points[(i + 1) % corner_points.size()] - corner_points[i];
        const double along = std::clamp((p - corner_points[i]) * edge / edge.norm_square(), 0., 1.);
        const double apart = p.distance(corner_points[i] + along * edge);
        if (apart < distance)
          {
            distance = apart;
            nearest  = i;
          }
      }
    return closed[nearest];
  }


  template <int dim>
  bool CrackGeometry<dim>::is_near(const Point<dim> &p, const double radius) const
  {
    for (unsigned int d = 0; d < dim; ++d)
      if (p[d] < lowest[d] - radius || p[d] > highest[d] + radius)
        return false;
    return dim == 1 || std::abs((p - corner_points[0]) * unit_normal) <= radius + tolerance;
  }


  template <int dim>
  void CrackGeometry<dim>::close_joints(const CrackGeometry &other)
  {
    const unsigned int n = static_cast<unsigned int>(corner_points.size());
    for (unsigned int i = 0; i < n; ++i)
      {
        const Point<dim> &a = corner_points[i], &b = corner_points[(i + 1) % n];
        if (other.contains(a) &&
            (dim == 2 || (other.contains(b) && other.contains(a + 0.5 * (b - a)))))
          close(i);
      }
  }


  template <int dim>
  void CrackGeometry<dim>::close(const unsigned int end)
  {
    closed[end] = true;
  }


  template <int dim>
  std::vector<CrackGeometry<dim>> make_crack_geometries(const std::vector<CrackPiece<dim>> &pieces)
  {
    std::vector<CrackGeometry<dim>> list, alone;
    for (const CrackPiece<dim> &piece : pieces)
      {
        alone.emplace_back(piece.corners);
        alone.back().crack = piece.crack;
        for (unsigned int i = 0; i < piece.closed.size(); ++i)
          if (piece.closed[i])
            alone.back().close(i);
      }
    list = alone;
    for (std::size_t i = 0; i < list.size(); ++i)
      for (std::size_t j = 0; j < list.size(); ++j)
        if (i != j)
          list[i].close_joints(alone[j]);
    return list;
  }


  template <int dim>
  std::vector<CrackGeometry<dim>> make_open_geometries(std::vector<CrackPiece<dim>> pieces)
  {
    for (CrackPiece<dim> &piece : pieces)
      piece.closed.clear();
    return make_crack_geometries(pieces);
  }


  PERIDEAL_INSTANTIATE_FUNCTION(make_open_geometries);
  PERIDEAL_INSTANTIATE_FUNCTION(make_crack_geometries);
  PERIDEAL_INSTANTIATE_CLASS(class CrackGeometry);
} // namespace PeriDeal
