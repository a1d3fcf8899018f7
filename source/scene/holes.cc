// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/domain.h>
#include <perideal/scene/holes.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>
#include <limits>

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


    Point<2> in_plane(const double x, const double y)
    {
      return Point<2>(x, y);
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
    std::pair<Point<2>, Point<2>> box(corners[0], corners[0]);
    for (const Point<2> &p : corners)
      for (unsigned int d = 0; d < 2; ++d)
        {
          box.first[d]  = std::min(box.first[d], p[d]);
          box.second[d] = std::max(box.second[d], p[d]);
        }
    return box;
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


  std::vector<Hole> parse_holes(const std::string &text, const std::string &where)
  {
    std::vector<Hole> holes;
    for (const std::string &piece : split_list(text, ';'))
      holes.push_back(make_hole(piece, where));
    return holes;
  }


  template <int dim>
  void Domain<dim>::parse_holes_of_list()
  {
    holes = parse_holes(text("Holes"), where("Holes"));
    if (holes.empty())
      return;
    if (shape == Shape::mesh_file || shape == Shape::image)
      error("Holes",
            "is for 'Shape = box' and 'plate with hole'; this body has its holes in the " +
              std::string(shape == Shape::image ? "image." : "mesh file."));
    if (dim == 1)
      error("Holes", "needs 'Dimension' 2 or 3.");
    has_one_hole = shape == Shape::plate_with_hole &&
                   (is_given("Hole center") || is_given("Hole radius"));
    shape                  = Shape::plate_with_hole;
    const Tensor<1, dim> h = spacing();
    for (const Hole &hole : holes)
      {
        // Some cell has to have its centre in the hole.
        const auto          box = hole.box();
        std::array<long, 2> from{}, to{};
        for (int d = 0; d < std::min(dim, 2); ++d)
          {
            from[d] = std::max(0L, static_cast<long>((box.first[d] - lower[d]) / h[d] - 1.));
            to[d]   = std::min(static_cast<long>(cells[d]) - 1,
                             static_cast<long>((box.second[d] - lower[d]) / h[d] + 1.));
          }
        bool found = false;
        for (long j = from[1]; j <= to[1] && !found; ++j)
          for (long i = from[0]; i <= to[0] && !found; ++i)
            found = hole.contains(in_plane(lower[0] + (i + 0.5) * h[0],
                                           dim > 1 ? lower[dim > 1] + (j + 0.5) * h[dim > 1] : 0.));
        if (!found)
          error(
            "Holes",
            "'" + hole.text +
              "' holds no centre of a cell: it lies outside the body, or is smaller than a cell. Move it, or take more 'Cells'.");
      }
  }


  template <int dim>
  double Domain<dim>::distance_to_holes(const Point<dim> &p) const
  {
    double shortest = std::numeric_limits<double>::max();
    for (const Hole &hole : holes)
      shortest = std::min(shortest, hole.distance(in_plane(p[0], dim > 1 ? p[dim > 1] : 0.)));
    if (shape == Shape::plate_with_hole && has_one_hole)
      {
        Tensor<1, dim> r = p - hole_center;
        if (dim == 3)
          r[dim - 1] = 0.;
        const double reach = hole_shape == HoleShape::circle ? hole_radius :
                                                               std::sqrt(2.) * hole_radius;
        shortest           = std::min(shortest, r.norm() - reach);
      }
    return shortest;
  }


#define PERIDEAL_INSTANTIATE(dim)                     \
  template void   Domain<dim>::parse_holes_of_list(); \
  template double Domain<dim>::distance_to_holes(const Point<dim> &) const;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
