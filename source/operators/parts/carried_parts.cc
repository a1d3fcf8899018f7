// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/quadrature_lib.h>

#include <perideal/operators/parts/carried_parts.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** A crack whose normal is most along an axis cuts no more cells in a row along it. */
    constexpr int most_in_row = 3;

    /** Of a cell: what is thinner is nothing. */
    constexpr double thin = 1e-9;
  } // namespace


  template <int dim>
  bool CarriedParts<dim>::apply_to(const BodyParameters<dim> &body)
  {
    return dim > 1 && body.domain.has_lattice() && !body.cracks.cracks.empty() &&
           !body.cracks.on_faces() && body.cracks.tips.empty();
  }


  template <int dim>
  CarriedParts<dim>::CarriedParts(const Domain<dim> &domain)
    : domain(domain)
  {}


  template <int dim>
  void CarriedParts<dim>::set(const std::vector<CrackPiece<dim>> &pieces)
  {
    cracks.clear();
    for (const CrackGeometry<dim> &piece : make_open_geometries(pieces))
      {
        unsigned int axis = 0;
        for (unsigned int d = 1; d < dim; ++d)
          if (std::abs(piece.normal()[d]) > std::abs(piece.normal()[axis]) + 1e-9)
            axis = d;
        cracks.push_back({piece, axis});
      }
  }


  template <int dim>
  double CarriedParts<dim>::reach() const
  {
    return (most_in_row + 1) * domain.spacing().norm() * std::exp2(domain.coarsening.times);
  }


  template <int dim>
  std::optional<double> CarriedParts<dim>::height(const Crack &crack, Point<dim> p)
  {
    const Tensor<1, dim> &normal = crack.geometry.normal();
    p[crack.axis] += (crack.geometry.corners()[0] - p) * normal / normal[crack.axis];
    return crack.geometry.covers(p) ? std::optional<double>(p[crack.axis]) :
                                      std::optional<double>();
  }


  template <int dim>
  bool CarriedParts<dim>::exists(const Box &box) const
  {
    const Point<dim> center = box.lower + 0.5 * box.size;
    for (unsigned int d = 0; d < dim; ++d)
      if (center[d] < domain.lower[d] || center[d] > domain.upper[d])
        return false;
    return domain.has_cell_at(center);
  }


  template <int dim>
  typename CarriedParts<dim>::Across CarriedParts<dim>::points_across(
    const Box         &box,
    const unsigned int axis,
    const Near        &near,
    const unsigned int n_points) const
  {
    Across          list;
    const QGauss<1> gauss(n_points);
    // In 2D pieces end where cracks do; the edges of polygons run anywhere.
    std::vector<double> ends{0., 1.};
    if (dim == 2)
      for (const Crack *const crack : near)
        for (const Point<dim> &corner : crack->geometry.corners())
          if (const double x = (corner[1 - axis] - box.lower[1 - axis]) / box.size[1 - axis];
              x > thin && x < 1. - thin)
            ends.push_back(x);
    if (dim == 3)
      ends = {0., 0.25, 0.5, 0.75, 1.};
    std::sort(ends.begin(), ends.end());
    std::vector<std::pair<double, double>> along;
    for (unsigned int k = 0; k + 1 < ends.size(); ++k)
      for (unsigned int q = 0; q < n_points && ends[k + 1] - ends[k] > thin; ++q)
        along.emplace_back(ends[k] + (ends[k + 1] - ends[k]) * gauss.point(q)[0],
                           (ends[k + 1] - ends[k]) * gauss.weight(q));
    list.emplace_back(Point<dim>(), 1.);
    for (unsigned int d = 0; d < dim; ++d)
      if (d != axis)
        {
          Across more;
          for (const auto &[p, weight] : list)
            for (const auto &[x, part] : along)
              {
                more.emplace_back(p, weight * part);
                more.back().first[d] = x;
              }
          list = std::move(more);
        }
    return list;
  }


  namespace
  {
    template <int dim, typename Box>
    Point<dim> place(const Box &box, const Point<dim> &unit)
    {
      Point<dim> p = box.lower;
      for (unsigned int d = 0; d < dim; ++d)
        p[d] += unit[d] * box.size[d];
      return p;
    }
  } // namespace


  template <int dim>
  typename CarriedParts<dim>::Near CarriedParts<dim>::cutting(const Box         &box,
                                                              const Near        &near,
                                                              const unsigned int n_points) const
  {
    Near found;
    for (const Crack *const crack : near)
      {
        bool left = false, right = false;
        for (unsigned int v = 0; v < GeometryInfo<dim>::vertices_per_cell; ++v)
          (crack->geometry.signed_distance(place(box, GeometryInfo<dim>::unit_cell_vertex(v))) >
               0. ?
             left :
             right) = true;
        if (!left || !right)
          continue;
        const Across points = points_across(box, crack->axis, near, n_points);
        if (std::any_of(points.begin(), points.end(), [&](const auto &point) {
              const auto z = height(*crack, place(box, point.first));
              // Not where the line of an oblique crack has left the cell before the crack begins.
              return z && std::abs((*z - box.lower[crack->axis]) / box.size[crack->axis] - 0.5) <
                            0.5 + thin;
            }))
          found.push_back(crack);
      }
    return found;
  }


  template <int dim>
  std::optional<Quadrature<dim>> CarriedParts<dim>::own_part(const Box         &box,
                                                             const Near        &near,
                                                             const Near        &through,
                                                             const unsigned int n_points) const
  {
    const unsigned int axis = through[0]->axis;
    if (std::any_of(through.begin(), through.end(), [&](const Crack *const crack) {
          return crack->axis != axis;
        }))
      return {};
    const QGauss<1>         gauss(n_points);
    std::vector<Point<dim>> points;
    std::vector<double>     weights;
    for (const auto &[p, weight] : points_across(box, axis, near, n_points))
      if (std::none_of(through.begin(), through.end(), [&, &p = p](const Crack *const crack) {
            return height(*crack, place(box, p)).has_value();
          }))
        for (unsigned int q = 0; q < n_points; ++q)
          {
            points.push_back(p);
            points.back()[axis] = gauss.point(q)[0];
            weights.push_back(weight * gauss.weight(q));
          }
    return Quadrature<dim>(points, weights);
  }


  template <int dim>
  unsigned int CarriedParts<dim>::n_removed_beyond(const Cell        &cell,
                                                   const Box         &box,
                                                   const unsigned int axis,
                                                   const int          way,
                                                   const Near        &near,
                                                   const unsigned int n_points) const
  {
    const bool graded = domain.coarsening.times > 0;
    if (graded)
      {
        // Farther cells may be of another size, or not known here.
        const unsigned int face = 2 * axis + (way > 0 ? 1 : 0);
        if (cell->at_boundary(face) || !cell->neighbor(face)->is_active() ||
            cell->neighbor(face)->level() != cell->level())
          return 0;
      }
    unsigned int n   = 0;
    Box          one = box;
    while (n < (graded ? 1 : most_in_row))
      {
        one.lower[axis] += way * box.size[axis];
        const Near through = exists(one) ? cutting(one, near, n_points) : Near();
        if (through.empty() ||
            std::any_of(through.begin(), through.end(), [&](const Crack *const crack) {
              return crack->axis != axis;
            }))
          break;
        ++n;
      }
    return n;
  }


  template <int dim>
  std::optional<Quadrature<dim>> CarriedParts<dim>::region(const Cell        &cell,
                                                           const unsigned int n_points) const
  {
    Box box{cell->vertex(0), {}};
    for (unsigned int d = 0; d < dim; ++d)
      box.size[d] = cell->extent_in_direction(d);
    Near near;
    for (const Crack &crack : cracks)
      if (crack.geometry.is_near(cell->center(), (most_in_row + 1) * cell->diameter()))
        near.push_back(&crack);
    if (near.empty())
      return {};
    if (const Near through = cutting(box, near, n_points); !through.empty())
      return own_part(box, near, through, n_points);
    const QGauss<1>         gauss(n_points);
    const QGauss<dim>       whole(n_points);
    std::vector<Point<dim>> points  = whole.get_points();
    std::vector<double>     weights = whole.get_weights();
    for (unsigned int axis = 0; axis < dim; ++axis)
      for (const int way : {-1, 1})
        {
          const unsigned int n = n_removed_beyond(cell, box, axis, way, near, n_points);
          if (n == 0)
            continue;
          const double side = box.lower[axis] + (way > 0 ? box.size[axis] : 0.);
          for (const auto &[p, weight] : points_across(box, axis, near, n_points))
            {
              double length = n + 1.; // in cells, to the first crack on the way
              for (const Crack *const crack : near)
                if (crack->axis == axis)
                  if (const auto z = height(*crack, place(box, p)))
                    if (const double apart = way * (*z - side) / box.size[axis]; apart > -thin)
                      length = std::min(length, apart);
              for (unsigned int q = 0; q < n_points && length > thin && length < n + thin; ++q)
                {
                  points.push_back(p);
                  points.back()[axis] = (way > 0 ? 1. : 0.) + way * length * gauss.point(q)[0];
                  weights.push_back(weight * length * gauss.weight(q));
                }
            }
        }
    if (points.size() == whole.size())
      return {};
    return Quadrature<dim>(points, weights);
  }


  template class CarriedParts<1>;
  template class CarriedParts<2>;
  template class CarriedParts<3>;
} // namespace PeriDeal
