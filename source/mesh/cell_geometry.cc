// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/tensor.h>

#include <perideal/mesh/cell_geometry.h>

#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  std::array<double, GeometryInfo<dim>::vertices_per_cell> shape_values(const Point<dim> &unit)
  {
    std::array<double, GeometryInfo<dim>::vertices_per_cell> values;
    for (unsigned int v = 0; v < values.size(); ++v)
      {
        values[v] = 1.;
        for (unsigned int d = 0; d < dim; ++d)
          values[v] *= ((v >> d) & 1) ? unit[d] : 1. - unit[d];
      }
    return values;
  }


  namespace
  {
    /** Derivatives of the coordinates along the directions of the unit cell: [coordinate][direction]. */
    template <int dim>
    Tensor<2, dim> jacobian_at(const CellCorners<dim> &corners, const Point<dim> &unit)
    {
      Tensor<2, dim> jacobian;
      for (unsigned int v = 0; v < corners.size(); ++v)
        for (unsigned int d = 0; d < dim; ++d)
          {
            double slope = ((v >> d) & 1) ? 1. : -1.;
            for (unsigned int e = 0; e < dim; ++e)
              if (e != d)
                slope *= ((v >> e) & 1) ? unit[e] : 1. - unit[e];
            for (unsigned int c = 0; c < dim; ++c)
              jacobian[c][d] += slope * corners[v][c];
          }
      return jacobian;
    }
  } // namespace


  template <int dim>
  double volume_element(const CellCorners<dim> &corners, const Point<dim> &unit)
  {
    return determinant(jacobian_at(corners, unit));
  }


  template <int dim>
  bool unit_point(const CellCorners<dim> &corners, const Point<dim> &p, Point<dim> &unit)
  {
    constexpr unsigned int most_steps = 30;
    for (unsigned int d = 0; d < dim; ++d)
      unit[d] = 0.5;
    for (unsigned int k = 0; k < most_steps; ++k)
      {
        Tensor<1, dim> defect = p - Point<dim>();
        const auto     values = shape_values(unit);
        for (unsigned int v = 0; v < corners.size(); ++v)
          for (unsigned int c = 0; c < dim; ++c)
            defect[c] -= values[v] * corners[v][c];
        const Tensor<2, dim> jacobian = jacobian_at(corners, unit);
        if (!(determinant(jacobian) > 0.))
          return false;
        const Tensor<1, dim> step = invert(jacobian) * defect;
        unit += step;
        if (step.norm() < 1e-15)
          break;
        if (!(unit.norm() < 1e3))
          return false;
      }
    return true;
  }


  namespace
  {
    constexpr double slack = 1e-6; // of a face, beyond its edges

    bool within_face(const double u)
    {
      return u > -slack && u < 1. + slack;
    }


    /** The real roots of c2 x^2 + c1 x + c0 that matter: those within a face. */
    void add_roots(const double c2, const double c1, const double c0, std::vector<double> &roots)
    {
      const double size = std::abs(c2) + std::abs(c1) + std::abs(c0);
      if (size == 0.)
        return;
      if (std::abs(c2) < 1e-14 * size)
        {
          if (c1 != 0.)
            roots.push_back(-c0 / c1);
          return;
        }
      const double radicand = c1 * c1 - 4. * c2 * c0;
      if (radicand < 0.)
        return;
      const double q = -0.5 * (c1 + std::copysign(std::sqrt(radicand), c1));
      roots.push_back(q / c2);
      if (q != 0.)
        roots.push_back(c0 / q);
    }


    void add_edge_crossing(const Point<2>      &p,
                           const Point<2>      &q,
                           const Point<2>      &a,
                           const Tensor<1, 2>  &along,
                           std::vector<double> &places)
    {
      const Tensor<1, 2> edge = q - p, gap = p - a;
      const double       determinant = along[0] * edge[1] - along[1] * edge[0];
      if (std::abs(determinant) < 1e-12 * along.norm() * edge.norm())
        return;
      if (within_face((along[1] * gap[0] - along[0] * gap[1]) / determinant))
        places.push_back((gap[0] * edge[1] - gap[1] * edge[0]) / determinant);
    }


    /** The face (1-u)(1-v) p0 + u (1-v) p1 + (1-u) v p2 + u v p3. */
    void add_face_crossing(const std::array<Point<3>, 4> &p,
                           const Point<3>                &a,
                           const Tensor<1, 3>            &along,
                           std::vector<double>           &places)
    {
      // Two directions across the line: there the face passes through a.
      unsigned int longest = 0;
      for (unsigned int d = 1; d < 3; ++d)
        if (std::abs(along[d]) > std::abs(along[longest]))
          longest = d;
      Tensor<1, 3> helper;
      helper[(longest + 1) % 3] = 1.;
      Tensor<1, 3> first        = cross_product_3d(along, helper);
      first /= first.norm();
      Tensor<1, 3> second = cross_product_3d(along, first);
      second /= second.norm();
      const Tensor<1, 3> c = p[0] - a, cu = p[1] - p[0], cv = p[2] - p[0],
                         cuv = (p[3] - p[2]) - (p[1] - p[0]);
      const double        a1 = c * first, b1 = cu * first, g1 = cv * first, d1 = cuv * first;
      const double        a2 = c * second, b2 = cu * second, g2 = cv * second, d2 = cuv * second;
      std::vector<double> roots;
      // (a1 + b1 u) + v (g1 + d1 u) = 0 and the same with 2, v eliminated.
      add_roots(b2 * d1 - b1 * d2, a2 * d1 + b2 * g1 - a1 * d2 - b1 * g2, a2 * g1 - a1 * g2, roots);
      for (const double u : roots)
        {
          const double under1 = g1 + d1 * u, under2 = g2 + d2 * u;
          const bool   use1 = std::abs(under1) > std::abs(under2);
          if ((use1 ? under1 : under2) == 0.)
            continue;
          const double v = use1 ? -(a1 + b1 * u) / under1 : -(a2 + b2 * u) / under2;
          if (within_face(u) && within_face(v))
            places.push_back((c + u * cu + v * cv + u * v * cuv) * along / along.norm_square());
        }
    }
  } // namespace


  template <int dim>
  void add_face_crossings(const CellCorners<dim> &corners,
                          const Point<dim>       &a,
                          const Point<dim>       &b,
                          std::vector<double>    &places)
  {
    const Tensor<1, dim> along = b - a;
    for (unsigned int f = 0; f < GeometryInfo<dim>::faces_per_cell; ++f)
      {
        const unsigned int normal = f / 2, side = f % 2;
        if constexpr (dim == 1)
          places.push_back((corners[side][0] - a[0]) / along[0]);
        else
          {
            std::array<Point<dim>, 1 << (dim - 1)> p;
            unsigned int                           n = 0;
            for (unsigned int v = 0; v < corners.size(); ++v)
              if (((v >> normal) & 1) == side)
                p[n++] = corners[v];
            if constexpr (dim == 2)
              add_edge_crossing(p[0], p[1], a, along, places);
            else
              add_face_crossing(p, a, along, places);
          }
      }
  }


#define PERIDEAL_INSTANTIATE(dim)                                                         \
  template std::array<double, GeometryInfo<dim>::vertices_per_cell> shape_values(         \
    const Point<dim> &);                                                                  \
  template double volume_element(const CellCorners<dim> &, const Point<dim> &);           \
  template bool   unit_point(const CellCorners<dim> &, const Point<dim> &, Point<dim> &); \
  template void   add_face_crossings(const CellCorners<dim> &,                            \
                                     const Point<dim> &,                                  \
                                     const Point<dim> &,                                  \
                                     std::vector<double> &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
