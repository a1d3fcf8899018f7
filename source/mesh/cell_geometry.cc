// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/tensor.h>

#include <perideal/base/instantiate.h>
#include <perideal/mesh/cell_geometry.h>

#include <algorithm>
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
    /**
     * Derivatives of the coordinates along the directions of the unit cell:
     * [coordinate][direction].
     */
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
    // x = sum over sets of directions of c[set] times their unit coordinates.
    std::array<Tensor<1, dim>, GeometryInfo<dim>::vertices_per_cell> c;
    for (unsigned int v = 0; v < c.size(); ++v)
      c[v] = corners[v] - p;
    for (unsigned int bit = 1; bit < c.size(); bit *= 2)
      for (unsigned int v = 0; v < c.size(); ++v)
        if (v & bit)
          c[v] -= c[v ^ bit];
    for (unsigned int k = 0; k < most_steps; ++k)
      {
        Tensor<1, dim> defect, step; // and the columns of the Jacobian
        double         determinant;
        if constexpr (dim == 1)
          {
            defect      = c[0] + unit[0] * c[1];
            determinant = c[1][0];
            step[0]     = defect[0] / determinant;
          }
        else if constexpr (dim == 2)
          {
            const Tensor<1, dim> a = c[1] + unit[1] * c[3], b = c[2] + unit[0] * c[3];
            defect      = c[0] + unit[0] * a + unit[1] * c[2];
            determinant = a[0] * b[1] - a[1] * b[0];
            step[0]     = (defect[0] * b[1] - defect[1] * b[0]) / determinant;
            step[1]     = (a[0] * defect[1] - a[1] * defect[0]) / determinant;
          }
        else
          {
            const Tensor<1, dim> a1 = c[1] + unit[2] * c[5], a3 = c[3] + unit[2] * c[7],
                                 b = c[2] + unit[0] * a3 + unit[2] * c[6], a = a1 + unit[1] * a3,
                                 e = c[4] + unit[0] * c[5] + unit[1] * (c[6] + unit[0] * c[7]);
            defect = c[0] + unit[0] * a + unit[1] * (c[2] + unit[2] * c[6]) + unit[2] * c[4];
            const Tensor<1, dim> be = cross_product_3d(b, e);
            determinant             = a * be;
            step[0]                 = (defect * be) / determinant;
            const Tensor<1, dim> ad = cross_product_3d(a, defect);
            step[1]                 = (ad * e) / determinant;
            step[2]                 = -(ad * b) / determinant;
          }
        if (!(determinant > 0.))
          return false;
        unit -= step;
        const double square = step.norm_square();
        if (square < 1e-18) // the next one would be below round-off
          break;
        if (!(square < 1e6))
          return false;
      }
    return true;
  }


  namespace
  {
    constexpr double beyond = 1e-6; // of a face, across its edges

    bool within_face(const double u)
    {
      return u > -beyond && u < 1. + beyond;
    }


    /** The real roots of c2 x^2 + c1 x + c0 that matter: those within a face. */
    void add_roots(const double  c2,
                   const double  c1,
                   const double  c0,
                   double       *roots,
                   unsigned int &n_roots)
    {
      const double size = std::abs(c2) + std::abs(c1) + std::abs(c0);
      if (size == 0.)
        return;
      if (std::abs(c2) < 1e-14 * size)
        {
          if (c1 != 0.)
            roots[n_roots++] = -c0 / c1;
          return;
        }
      const double radicand = c1 * c1 - 4. * c2 * c0;
      if (radicand < 0.)
        return;
      const double q   = -0.5 * (c1 + std::copysign(std::sqrt(radicand), c1));
      roots[n_roots++] = q / c2;
      if (q != 0.)
        roots[n_roots++] = c0 / q;
    }


    void add_edge_crossing(const Point<2>      &p,
                           const Point<2>      &q,
                           const Point<2>      &a,
                           const Tensor<1, 2>  &along,
                           std::vector<double> &places)
    {
      const Tensor<1, 2> edge = q - p, gap = p - a;
      const double       determinant = along[0] * edge[1] - along[1] * edge[0];
      if (determinant * determinant < 1e-24 * along.norm_square() * edge.norm_square())
        return;
      if (within_face((along[1] * gap[0] - along[0] * gap[1]) / determinant))
        places.push_back((gap[0] * edge[1] - gap[1] * edge[0]) / determinant);
    }


    /** A corner of a face: where it lies across the line, and along it. */
    struct AcrossLine
    {
      double first, second, along;
    };


    /**
     * The face (1-u)(1-v) p0 + u (1-v) p1 + (1-u) v p2 + u v p3, and where the line passes it:
     * there the face has the values 0, 0 across.
     */
    void add_face_crossing(const std::array<AcrossLine, 4> &p,
                           const double                     tolerance,
                           std::vector<double>             &places)
    {
      for (double AcrossLine::*const x : {&AcrossLine::first, &AcrossLine::second})
        {
          const auto [low, high] = std::minmax({p[0].*x, p[1].*x, p[2].*x, p[3].*x});
          if (low > tolerance || high < -tolerance)
            return;
        }
      const double a1 = p[0].first, b1 = p[1].first - a1, g1 = p[2].first - a1,
                   d1 = (p[3].first - p[2].first) - b1;
      const double a2 = p[0].second, b2 = p[1].second - a2, g2 = p[2].second - a2,
                   d2 = (p[3].second - p[2].second) - b2;
      double       roots[2];
      unsigned int n_roots = 0;
      // (a1 + b1 u) + v (g1 + d1 u) = 0 and the same with 2, v eliminated.
      add_roots(b2 * d1 - b1 * d2,
                a2 * d1 + b2 * g1 - a1 * d2 - b1 * g2,
                a2 * g1 - a1 * g2,
                roots,
                n_roots);
      for (unsigned int k = 0; k < n_roots; ++k)
        {
          const double u = roots[k], under1 = g1 + d1 * u, under2 = g2 + d2 * u;
          const bool   use1 = std::abs(under1) > std::abs(under2);
          if ((use1 ? under1 : under2) == 0.)
            continue;
          const double v = use1 ? -(a1 + b1 * u) / under1 : -(a2 + b2 * u) / under2;
          if (within_face(u) && within_face(v))
            places.push_back((1. - v) * ((1. - u) * p[0].along + u * p[1].along) +
                             v * ((1. - u) * p[2].along + u * p[3].along));
        }
    }


    void add_bilinear_crossings(const CellCorners<3> &corners,
                                const Point<3>       &a,
                                const Tensor<1, 3>   &along,
                                std::vector<double>  &places)
    {
      // Two directions across the line.
      unsigned int longest = 0;
      for (unsigned int d = 1; d < 3; ++d)
        if (std::abs(along[d]) > std::abs(along[longest]))
          longest = d;
      Tensor<1, 3> helper;
      helper[(longest + 1) % 3] = 1.;
      const Tensor<1, 3> first  = cross_product_3d(along, helper),
                         second = cross_product_3d(along, first);
      const double by_first = 1. / first.norm(), by_second = 1. / second.norm(),
                   by_along = 1. / along.norm_square();
      std::array<AcrossLine, 8> p;
      for (unsigned int v = 0; v < 8; ++v)
        {
          const Tensor<1, 3> x = corners[v] - a;
          p[v] = {(x * first) * by_first, (x * second) * by_second, (x * along) * by_along};
        }
      // What is admitted beyond the edges, with some room.
      const double           tolerance = 10. * beyond * (corners[7] - corners[0]).norm();
      constexpr unsigned int faces[6][4] =
        {{0, 2, 4, 6}, {1, 3, 5, 7}, {0, 1, 4, 5}, {2, 3, 6, 7}, {0, 1, 2, 3}, {4, 5, 6, 7}};
      for (const auto &f : faces)
        add_face_crossing({{p[f[0]], p[f[1]], p[f[2]], p[f[3]]}}, tolerance, places);
    }
  } // namespace


  template <int dim>
  void add_face_crossings(const CellCorners<dim> &corners,
                          const Point<dim>       &a,
                          const Point<dim>       &b,
                          std::vector<double>    &places)
  {
    const Tensor<1, dim> along = b - a;
    if constexpr (dim == 3)
      {
        add_bilinear_crossings(corners, a, along, places);
        return;
      }
    else
      for (unsigned int f = 0; f < GeometryInfo<dim>::faces_per_cell; ++f)
        {
          const unsigned int normal = f / 2, side = f % 2;
          if constexpr (dim == 1)
            places.push_back((corners[side][0] - a[0]) / along[0]);
          else
            {
              const unsigned int other = normal == 0 ? 2 : 1, first = side << normal;
              add_edge_crossing(corners[first], corners[first + other], a, along, places);
            }
        }
  }


  PERIDEAL_INSTANTIATE_FUNCTION(shape_values);
  PERIDEAL_INSTANTIATE_FUNCTION(volume_element);
  PERIDEAL_INSTANTIATE_FUNCTION(unit_point);
  PERIDEAL_INSTANTIATE_FUNCTION(add_face_crossings);
} // namespace PeriDeal
