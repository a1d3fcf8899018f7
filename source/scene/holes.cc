// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/bounding_box.h>

#include <perideal/base/instantiate.h>
#include <perideal/scene/holes.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    Hole make_hole(const std::string &piece, const std::string &where)
    {
      const auto [kind, numbers] = name_and_value(piece, where);
      const unsigned int which   = choice_of(kind, {"circle", "rectangle", "polygon"}, where);
      const std::string  at      = where + ", " + kind;
      Hole               hole;
      hole.text = piece;
      if (which == 0)
        {
          const std::vector<double> c = parse_numbers(numbers, 3, "numbers (x, y, radius)", at);
          if (!(c[2] > 0.))
            entry_error(at,
                        "'" + numbers + "' has the radius " + number_text(c[2]) +
                          ", needs one greater than 0.");
          hole.center = Point<2>(c[0], c[1]);
          hole.radius = c[2];
          return hole;
        }
      if (which == 1)
        {
          const std::vector<double> c =
            parse_numbers(numbers,
                          4,
                          "numbers (x, y of the lower left and of the upper right corner)",
                          at);
          if (!(c[0] < c[2] && c[1] < c[3]))
            entry_error(at,
                        "'" + numbers +
                          "': the second corner must have greater coordinates than the first.");
          hole.corners = {{c[0], c[1]}, {c[2], c[1]}, {c[2], c[3]}, {c[0], c[3]}};
          return hole;
        }
      const unsigned int n = split_list(numbers, ',').size();
      if (n < 6 || n % 2 == 1)
        entry_error(at,
                    "'" + numbers + "' needs x, y of three or more corners, found " +
                      std::to_string(n) + " numbers.");
      const std::vector<double> c = parse_numbers(numbers, n, "numbers", at);
      for (unsigned int k = 0; k < n; k += 2)
        hole.corners.emplace_back(c[k], c[k + 1]);
      if (!(hole.area() > 0.))
        entry_error(at, "'" + numbers + "' has no area.");
      return hole;
    }
  } // namespace


  bool Hole::contains(const Point<2> &p) const
  {
    if (corners.empty())
      return p.distance(center) < radius;
    bool inside = false; // by the crossings of a ray along x
    for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++)
      {
        const Point<2> &a = corners[i], &b = corners[j];
        if ((a[1] > p[1]) != (b[1] > p[1]) &&
            p[0] < (b[0] - a[0]) * (p[1] - a[1]) / (b[1] - a[1]) + a[0])
          inside = !inside;
      }
    return inside;
  }


  double Hole::distance(const Point<2> &p) const
  {
    if (corners.empty())
      return p.distance(center) - radius;
    double shortest = std::numeric_limits<double>::max();
    for (std::size_t i = 0; i < corners.size(); ++i)
      {
        const Point<2>     a    = corners[i];
        const Tensor<1, 2> edge = corners[(i + 1) % corners.size()] - a;
        const double       s    = std::clamp((p - a) * edge / edge.norm_square(), 0., 1.);
        shortest                = std::min(shortest, p.distance(a + s * edge));
      }
    return contains(p) ? -shortest : shortest;
  }


  std::pair<Point<2>, Point<2>> Hole::box() const
  {
    if (corners.empty())
      return {Point<2>(center[0] - radius, center[1] - radius),
              Point<2>(center[0] + radius, center[1] + radius)};
    return BoundingBox<2>(corners).get_boundary_points();
  }


  double Hole::area() const
  {
    if (corners.empty())
      return std::acos(-1.) * radius * radius;
    double twice = 0.;
    for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++)
      twice += corners[j][0] * corners[i][1] - corners[i][0] * corners[j][1];
    return 0.5 * std::abs(twice);
  }


  double Hole::place_on_rim(const Point<2> &p) const
  {
    if (corners.empty())
      return radius * std::atan2(p[1] - center[1], p[0] - center[0]);
    double shortest = std::numeric_limits<double>::max(), place = 0., before = 0.;
    for (std::size_t i = 0; i < corners.size(); ++i)
      {
        const Point<2>     a    = corners[i];
        const Tensor<1, 2> edge = corners[(i + 1) % corners.size()] - a;
        const double       s    = std::clamp((p - a) * edge / edge.norm_square(), 0., 1.);
        if (const double found = p.distance(a + s * edge); found < shortest)
          {
            shortest = found;
            place    = before + s * edge.norm();
          }
        before += edge.norm();
      }
    return place;
  }


  Point<2> Hole::point_on_rim(const double place) const
  {
    if (corners.empty())
      return center + radius * Point<2>(std::cos(place / radius), std::sin(place / radius));
    double rest = place - std::floor(place / rim_length()) * rim_length();
    for (std::size_t i = 0;; ++i)
      {
        const Tensor<1, 2> edge = corners[(i + 1) % corners.size()] - corners[i];
        if (rest <= edge.norm() || i + 1 == corners.size())
          return corners[i] + rest / edge.norm() * edge;
        rest -= edge.norm();
      }
  }


  double Hole::rim_length() const
  {
    if (corners.empty())
      return 2. * std::acos(-1.) * radius;
    double length = 0.;
    for (std::size_t i = 0; i < corners.size(); ++i)
      length += corners[i].distance(corners[(i + 1) % corners.size()]);
    return length;
  }


  double Hole::rim_between(const Point<2> &a, const Point<2> &b) const
  {
    const double way = std::abs(place_on_rim(a) - place_on_rim(b));
    return std::min(way, rim_length() - way); // around the other way
  }


  std::vector<Hole> parse_holes(const std::string &text, const std::string &where)
  {
    std::vector<Hole> holes;
    for (const std::string &piece : split_list(text, ';'))
      holes.push_back(make_hole(piece, where));
    return holes;
  }


  namespace
  {
    bool is_in_earlier_row(const Point<2> &p, const Hole &joint)
    {
      const Point<2> &corner = joint.corners[0];
      return p[1] < corner[1] || (p[1] == corner[1] && p[0] < corner[0]);
    }
  } // namespace


  template <int dim>
  bool Holes<dim>::contains(const Point<dim> &p) const
  {
    if (dim > 1)
      {
        const Point<2> q(p[0], p[dim > 1]);
        auto           hole = listed.begin();
        for (; hole != listed.end() && !hole->text.empty(); ++hole)
          if (hole->contains(q))
            return true;
        // Of joints, which can be thousands, the last one that begins before q in its row.
        const auto row =
          std::upper_bound(hole, listed.end(), q[1], [](const double y, const Hole &joint) {
            return y < joint.corners[0][1];
          });
        if (row != hole)
          {
            const Point<2> at(q[0], std::prev(row)->corners[0][1]);
            const auto     next = std::upper_bound(hole, row, at, is_in_earlier_row);
            if (next != hole && std::prev(next)->contains(q))
              return true;
          }
      }
    if (!has_one)
      return false;
    Tensor<1, dim> r = p - center;
    if (dim == 3) // the hole of a thick plate is a bore along z
      r[dim - 1] = 0.;
    if (shape == HoleShape::circle)
      return r.norm() < radius;
    const double turn = angle * std::acos(-1.) / 180., y = dim > 1 ? r[dim > 1] : 0.;
    const double along  = std::cos(turn) * r[0] + std::sin(turn) * y,
                 across = -std::sin(turn) * r[0] + std::cos(turn) * y;
    return std::max(std::abs(along), std::abs(across)) < radius;
  }


  template <int dim>
  double Holes<dim>::distance(const Point<dim> &p) const
  {
    double shortest = std::numeric_limits<double>::max();
    for (const Hole &hole : listed)
      shortest = std::min(shortest, hole.distance(Point<2>(p[0], dim > 1 ? p[dim > 1] : 0.)));
    if (has_one)
      {
        Tensor<1, dim> r = p - center;
        if (dim == 3)
          r[dim - 1] = 0.;
        const double reach = shape == HoleShape::circle ? radius : std::sqrt(2.) * radius;
        shortest           = std::min(shortest, r.norm() - reach);
      }
    return shortest;
  }


  template <int dim>
  std::vector<Hole> Holes<dim>::all() const
  {
    std::vector<Hole> list;
    for (const Hole &hole : listed)
      if (!hole.text.empty()) // no joint
        list.push_back(hole);
    if (!has_one || dim == 1)
      return list;
    Hole hole;
    hole.center = Point<2>(center[0], center[dim > 1]);
    if (shape == HoleShape::circle)
      hole.radius = radius;
    else
      for (unsigned int k = 0; k < 4; ++k)
        {
          const double turn = (angle + 45. + 90. * k) * std::acos(-1.) / 180.;
          hole.corners.push_back(hole.center +
                                 std::sqrt(2.) * radius * Point<2>(std::cos(turn), std::sin(turn)));
        }
    list.push_back(hole);
    return list;
  }


  PERIDEAL_INSTANTIATE_CLASS(struct Holes);
} // namespace PeriDeal
