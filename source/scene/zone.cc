// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/scene/zone.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    double distance_to_segment(const Point<dim> &a, const Point<dim> &b, const Point<dim> &p)
    {
      const Tensor<1, dim> along  = b - a;
      const double         square = along.norm_square();
      const double         s = square > 0. ? std::clamp(((p - a) * along) / square, 0., 1.) : 0.;
      return p.distance(a + s * along);
    }


    /**
     * Whether the foot of the perpendicular from p lies within a planar polygon: it is seen under a
     * winding angle that is not zero.
     */
    bool foot_inside(const std::vector<Point<3>> &corners,
                     const Tensor<1, 3>          &normal,
                     const Point<3>              &p)
    {
      double winding = 0.;
      for (unsigned int i = 0; i < corners.size(); ++i)
        {
          Tensor<1, 3> a = corners[i] - p, b = corners[(i + 1) % corners.size()] - p;
          a -= (a * normal) * normal;
          b -= (b * normal) * normal;
          winding += std::atan2(cross_product_3d(a, b) * normal, a * b);
        }
      return std::abs(winding) > 3.;
    }


    /** Directions in space, evenly spread: two, on a circle, or on a spiral around the sphere. */
    template <int dim>
    std::vector<Tensor<1, dim>> some_directions()
    {
      const double                pi = std::acos(-1.);
      const unsigned int          n  = dim == 1 ? 2 : dim == 2 ? 24 : 64;
      std::vector<Tensor<1, dim>> directions(n);
      for (unsigned int k = 0; k < n; ++k)
        {
          const double height = dim == 3 ? 1. - (2. * k + 1.) / n : 0.,
                       radius = std::sqrt(1. - height * height),
                       angle  = dim == 3 ? pi * (3. - std::sqrt(5.)) * k : 2. * pi * k / n;
          directions[k][0]    = radius * std::cos(angle);
          if constexpr (dim > 1)
            directions[k][1] = radius * std::sin(angle);
          if constexpr (dim > 2)
            directions[k][2] = height;
        }
      return directions;
    }
  } // namespace


  template <int dim>
  double distance_to_piece(const std::vector<Point<dim>> &corners, const Point<dim> &p)
  {
    if constexpr (dim == 3)
      {
        if (Tensor<1, 3> normal = doubled_area_vector(corners); normal.norm() > 0.)
          {
            normal /= normal.norm();
            if (foot_inside(corners, normal, p))
              return std::abs((p - corners[0]) * normal);
          }
      }
    double nearest = std::numeric_limits<double>::max();
    for (unsigned int i = 0; i < corners.size(); ++i)
      nearest =
        std::min(nearest, distance_to_segment(corners[i], corners[(i + 1) % corners.size()], p));
    return nearest;
  }


  template <int dim>
  Zone<dim>::Zone(const CouplingControl &control, const double horizon)
    : kind(control.zone)
    , reach(control.width * horizon)
    , formula(control.formula)
    , directions(some_directions<dim>())
  {}


  template <int dim>
  Zone<dim>::Zone(const Expression &formula)
    : kind(ZoneKind::formula)
    , formula(formula)
    , directions(some_directions<dim>())
  {}


  template <int dim>
  Zone<dim> Zone<dim>::near_cracks(const double reach)
  {
    Zone zone;
    zone.kind       = ZoneKind::near_cracks;
    zone.reach      = reach;
    zone.directions = some_directions<dim>();
    return zone;
  }


  template <int dim>
  void Zone<dim>::set_cracks(std::vector<CrackPiece<dim>> pieces)
  {
    cracks = std::move(pieces);
    boxes.clear();
    for (const CrackPiece<dim> &piece : cracks)
      boxes.emplace_back(piece.corners);
  }


  template <int dim>
  double Zone<dim>::distance_to_formula(const Point<dim> &p, const double farthest) const
  {
    if (formula.value(p) > 0.)
      return 0.;
    const auto is_in = [&](const Point<dim> &q) {
      return (!body || body->point_inside(q)) && formula.value(q) > 0.;
    };
    constexpr unsigned int n_steps = 8, n_halvings = 12;
    double                 nearest = farthest;
    for (const Tensor<1, dim> &direction : directions)
      {
        const double step = farthest / n_steps;
        for (double r = step; r - step < nearest; r += step)
          if (is_in(p + r * direction))
            {
              double outside = r - step, inside = r;
              for (unsigned int k = 0; k < n_halvings; ++k)
                {
                  const double middle                                = 0.5 * (outside + inside);
                  (is_in(p + middle * direction) ? inside : outside) = middle;
                }
              nearest = std::min(nearest, inside);
              break;
            }
      }
    return nearest;
  }


  template <int dim>
  double Zone<dim>::distance(const Point<dim> &p, const double farthest) const
  {
    if (kind == ZoneKind::everywhere)
      return 0.;
    if (kind == ZoneKind::formula)
      return distance_to_formula(p, farthest);
    double       nearest = farthest;
    const double slack   = 1e-9 * reach; // nodes just that far away are in, whatever the rounding
    for (unsigned int k = 0; k < cracks.size(); ++k)
      {
        const double limit = reach + nearest + slack;
        bool         far   = false;
        for (unsigned int d = 0; d < dim; ++d)
          far = far || p[d] < boxes[k].lower_bound(d) - limit ||
                p[d] > boxes[k].upper_bound(d) + limit;
        if (!far)
          nearest = std::min(nearest,
                             std::max(0., distance_to_piece(cracks[k].corners, p) - reach - slack));
      }
    return nearest;
  }


  template <int dim>
  bool Zone<dim>::contains(const Point<dim> &p) const
  {
    return kind == ZoneKind::formula ? formula.value(p) > 0. : distance(p, 1.) == 0.;
  }

  template <int dim>
  double Zone<dim>::weight(const Point<dim> &p, const double width_outside) const
  {
    if (width_outside == 0.)
      return contains(p) ? 1. : 0.;
    return 1. - std::min(1., distance(p, width_outside) / width_outside);
  }

  PERIDEAL_INSTANTIATE_FUNCTION(distance_to_piece);
  PERIDEAL_INSTANTIATE_CLASS(class Zone);
} // namespace PeriDeal
