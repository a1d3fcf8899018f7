// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/quadrature_lib.h>

#include <perideal/base/instantiate.h>
#include <perideal/mesh/part_faces.h>

#include <cmath>
#include <utility>

namespace PeriDeal
{
  using namespace dealii;

  namespace PartFaces
  {
    using Interval = std::pair<double, double>;

    constexpr unsigned int n_samples = 16, n_lines = 16, n_looks = 8, n_halvings = 52;


    /** Where in [0, 1] something holds, as intervals. */
    template <typename Holds>
    std::vector<Interval> intervals(const Holds &holds)
    {
      std::vector<Interval> result;
      const auto            change = [&](double a, double b, const bool at_a) {
        for (unsigned int k = 0; k < n_halvings; ++k)
          {
            const double middle             = 0.5 * (a + b);
            (holds(middle) == at_a ? a : b) = middle;
          }
        return 0.5 * (a + b);
      };
      bool   before = holds(0.);
      double begin  = 0.;
      for (unsigned int k = 1; k <= n_samples; ++k)
        {
          const double s   = static_cast<double>(k) / n_samples;
          const bool   now = holds(s);
          if (now == before)
            continue;
          const double at = change(static_cast<double>(k - 1) / n_samples, s, before);
          if (before)
            result.emplace_back(begin, at);
          begin  = at;
          before = now;
        }
      if (before)
        result.emplace_back(begin, 1.);
      return result;
    }


    /**
     * A face of a cell that is mapped by its vertices; places on it by dim - 1 coordinates from 0
     * to 1.
     */
    template <int dim>
    class MappedFace
    {
    public:
      using Place = std::array<double, 2>;

      MappedFace(const CellVertices<dim> &vertices, const unsigned int number)
        : vertices(vertices)
        , normal(number / 2)
        , end(number % 2)
      {}

      Point<dim> unit(const Place &s) const
      {
        Point<dim>   p;
        unsigned int k = 0;
        for (unsigned int d = 0; d < dim; ++d)
          p[d] = d == normal ? end : s[k++];
        return p;
      }

      Point<dim> real(const Point<dim> &unit) const
      {
        Point<dim> p;
        for (unsigned int v = 0; v < vertices.size(); ++v)
          p += GeometryInfo<dim>::d_linear_shape_function(unit, v) * (vertices[v] - Point<dim>());
        return p;
      }

      double area_element(const Point<dim> &unit) const
      {
        std::array<Tensor<1, dim>, 2> tangents{};
        for (unsigned int v = 0; v < vertices.size(); ++v)
          {
            const Tensor<1, dim> gradient =
              GeometryInfo<dim>::d_linear_shape_function_gradient(unit, v);
            unsigned int k = 0;
            for (unsigned int d = 0; d < dim; ++d)
              if (d != normal)
                tangents[k++] += gradient[d] * (vertices[v] - Point<dim>());
          }
        if constexpr (dim == 1)
          return 1.;
        if constexpr (dim == 2)
          return tangents[0].norm();
        const double a = tangents[0] * tangents[0], b = tangents[1] * tangents[1],
                     c = tangents[0] * tangents[1];
        return std::sqrt(a * b - c * c);
      }

    private:
      const CellVertices<dim> &vertices;
      const unsigned int       normal, end;
    };
  } // namespace PartFaces

  using namespace PartFaces;


  template <int dim>
  FacePoints<dim> points_in_part(const CellVertices<dim> &vertices,
                                 const unsigned int       face,
                                 const Part              &part,
                                 const unsigned int       n_points)
  {
    using Place = typename MappedFace<dim>::Place;
    const MappedFace<dim> of(vertices, face);
    FacePoints<dim>       result;
    const auto            holds = [&](const Place &s) { return part.holds(of.real(of.unit(s))); };
    const auto            add   = [&](const Place &s, const double weight) {
      const Point<dim> unit = of.unit(s);
      result.unit.push_back(unit);
      result.real.push_back(of.real(unit));
      result.area.push_back(weight * of.area_element(unit));
    };
    constexpr double round_off = 1e-12;
    const QGauss<1>  gauss(n_points);
    const auto       add_pieces = [&](const double second, const double weight) {
      for (const Interval &piece : intervals([&](const double s) { return holds({{s, second}}); }))
        if (const double length = piece.second - piece.first; length > round_off)
          for (unsigned int q = 0; q < n_points; ++q)
            add({{piece.first + length * gauss.point(q)[0], second}},
                weight * length * gauss.weight(q));
    };
    if constexpr (dim == 1)
      {
        if (holds({{0., 0.}}))
          add({{0., 0.}}, 1.);
      }
    else if constexpr (dim == 2)
      add_pieces(0., 1.);
    else
      {
        unsigned int n_inside = 0;
        for (unsigned int i = 0; i <= n_looks; ++i)
          for (unsigned int j = 0; j <= n_looks; ++j)
            n_inside += holds({{1. * i / n_looks, 1. * j / n_looks}}) ? 1 : 0;
        if (n_inside == 0)
          return result;
        const bool         whole = n_inside == (n_looks + 1) * (n_looks + 1);
        const unsigned int n     = whole ? 1 : n_lines;
        for (unsigned int k = 0; k < n; ++k)
          for (unsigned int q = 0; q < n_points; ++q)
            {
              const double second = (k + gauss.point(q)[0]) / n, weight = gauss.weight(q) / n;
              if (!whole)
                add_pieces(second, weight);
              else
                for (unsigned int r = 0; r < n_points; ++r)
                  add({{gauss.point(r)[0], second}}, weight * gauss.weight(r));
            }
      }
    return result;
  }


  template <int dim>
  RimFactors<dim>::RimFactors(const Holes<dim> &holes, const Triangulation<dim> &mesh)
  {
    if constexpr (dim > 1)
      {
        if (!holes.has_one && holes.listed.empty())
          return;
        // All processes have all cells of the coarsest level. Faces one above the other are one.
        const auto in_plane = [](const auto &p) { return Point<2>(p[0], p[1]); };
        std::map<std::array<double, 4>, std::size_t> numbers;
        std::vector<RimFace>                         faces;
        std::vector<std::pair<int, std::size_t>>     found;
        Point<2> lower = in_plane(mesh.begin(0)->vertex(0)), upper = lower;
        for (const auto &cell : mesh.cell_iterators_on_level(0))
          for (const unsigned int f : cell->face_indices())
            {
              const auto     face = cell->face(f);
              const Point<2> a    = in_plane(face->vertex(0)),
                             b    = in_plane(face->vertex(face->n_vertices() - 1));
              for (unsigned int d = 0; d < 2; ++d)
                {
                  lower[d] = std::min({lower[d], a[d], b[d]});
                  upper[d] = std::max({upper[d], a[d], b[d]});
                }
              if (!face->at_boundary() || face->boundary_id() != hole_boundary_id)
                continue;
              const auto [number, is_new] =
                numbers.try_emplace({{a[0], a[1], b[0], b[1]}}, faces.size());
              if (is_new)
                {
                  const Tensor<1, 2> outward = in_plane(face->center()) - in_plane(cell->center());
                  faces.push_back({a, b, outward / outward.norm()});
                }
              found.emplace_back(face->index(), number->second);
            }
        const std::vector<double> factors = holes.rim_over_faces(faces, lower, upper);
        for (const auto &[face, number] : found)
          of_face[face] = factors[number];
      }
  }


  PERIDEAL_INSTANTIATE_CLASS(class RimFactors);
  PERIDEAL_INSTANTIATE_FUNCTION(points_in_part);
} // namespace PeriDeal
