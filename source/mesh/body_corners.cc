// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/mesh/body_corners.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    // The vertices of a corner: one in two dimensions, the two of an edge in three.
    template <int dim>
    using CornerKey = std::array<unsigned int, dim == 3 ? 2 : 1>;

    template <int dim>
    CornerKey<dim> key_of(CornerKey<dim> vertices)
    {
      std::sort(vertices.begin(), vertices.end());
      return vertices;
    }


    /** What the cells and boundary faces at a corner are. */
    struct Seen
    {
      double                          angle = 0.; // inside the body
      std::vector<types::boundary_id> sides;
      std::vector<types::manifold_id> manifolds; // of boundary faces
    };


    double angle_between(const Tensor<1, 2> &a, const Tensor<1, 2> &b)
    {
      return std::atan2(std::abs(a[0] * b[1] - a[1] * b[0]), a * b);
    }


    /** Between the parts of two directions that are normal to a third one. */
    double angle_around(const Tensor<1, 3> &axis, Tensor<1, 3> a, Tensor<1, 3> b)
    {
      a -= (a * axis) / axis.norm_square() * axis;
      b -= (b * axis) / axis.norm_square() * axis;
      return std::acos(std::clamp(a * b / (a.norm() * b.norm()), -1., 1.));
    }


    using Corners2 = std::map<CornerKey<2>, Seen>;
    using Corners3 = std::map<CornerKey<3>, Seen>;

    void add_angles(const Triangulation<2>::cell_iterator &cell, Corners2 &corners)
    {
      constexpr std::array<unsigned int, 4> around = {{0, 1, 3, 2}};
      for (unsigned int k = 0; k < 4; ++k)
        {
          const unsigned int v = around[k];
          const Point<2>    &p = cell->vertex(v);
          corners[{{cell->vertex_index(v)}}].angle +=
            angle_between(cell->vertex(around[(k + 1) % 4]) - p,
                          cell->vertex(around[(k + 3) % 4]) - p);
        }
    }


    void add_angles(const Triangulation<3>::cell_iterator &cell, Corners3 &corners)
    {
      // An edge along one axis of the cell; the two faces there go on along the two others.
      for (unsigned int v = 0; v < 8; ++v)
        for (unsigned int d = 0; d < 3; ++d)
          {
            const unsigned int w = v | (1u << d);
            if (w == v)
              continue;
            const unsigned int a = (d + 1) % 3, b = (d + 2) % 3;
            const Point<3>    &p = cell->vertex(v);
            corners[key_of<3>({{cell->vertex_index(v), cell->vertex_index(w)}})].angle +=
              angle_around(cell->vertex(w) - p,
                           cell->vertex(v ^ (1u << a)) - p,
                           cell->vertex(v ^ (1u << b)) - p);
          }
    }


    template <int dim>
    void add_face(const typename Triangulation<dim>::cell_iterator &cell,
                  const unsigned int                                f,
                  std::map<CornerKey<dim>, Seen>                   &corners)
    {
      const auto face = cell->face(f);
      const auto add  = [&](const CornerKey<dim> &key) {
        Seen &seen = corners[key];
        seen.sides.push_back(face->boundary_id());
        seen.manifolds.push_back(face->manifold_id());
      };
      if constexpr (dim == 2)
        for (const unsigned int v : face->vertex_indices())
          add({{face->vertex_index(v)}});
      else
        for (unsigned int l = 0; l < GeometryInfo<dim>::lines_per_face; ++l)
          add(key_of<dim>({{face->line(l)->vertex_index(0), face->line(l)->vertex_index(1)}}));
    }


    /** Whether a value of the unknown itself is given on a side. */
    template <int dim>
    bool holds(const BoundaryConditions<dim> &given, const types::boundary_id side)
    {
      return find_condition(given.dirichlet, side) != nullptr ||
             find_condition(given.displacement, side) != nullptr ||
             std::find(given.symmetry.begin(), given.symmetry.end(), side) != given.symmetry.end();
    }


    /** Whether two of the values that sides give at a point differ, at the start or the end. */
    template <int dim>
    bool values_disagree(const Scene<dim> &scene, const Seen &seen, const Point<dim> &p)
    {
      constexpr double            small = 1e-3;
      const DeferredFormulaErrors ignored; // they are told where the values are used
      const auto                 &given = scene.boundary_conditions;
      for (const double t : {0., scene.time.steady ? 0. : scene.time.end_time})
        for (unsigned int c = 0; c < dim; ++c)
          {
            double least = std::numeric_limits<double>::max(), most = -least;
            for (const types::boundary_id side : seen.sides)
              {
                const Expression *value = nullptr;
                if (const auto *const fixed = find_condition(given.dirichlet, side))
                  value = &fixed->value;
                else if (const auto *const moved = find_condition(given.displacement, side))
                  value = moved->values[c] ? &*moved->values[c] : nullptr;
                if (value != nullptr)
                  {
                    least = std::min(least, value->value(p, t));
                    most  = std::max(most, value->value(p, t));
                  }
              }
            if (most - least > small * std::max(std::abs(least), std::abs(most)))
              return true;
          }
      return false;
    }


    template <int dim>
    bool is_rough(const Scene<dim> &scene, const Seen &seen, const Point<dim> &p)
    {
      const BoundaryConditions<dim> &given = scene.boundary_conditions;
      const double                   half  = std::acos(-1.);
      constexpr double               wide = 1.1, blunt = 0.6; // in half turns
      if (seen.sides.empty())
        return false;
      const bool is_round = seen.manifolds[0] != numbers::flat_manifold_id &&
                            std::all_of(seen.manifolds.begin(),
                                        seen.manifolds.end(),
                                        [&](const auto id) { return id == seen.manifolds[0]; });
      if (!is_round && seen.angle > wide * half)
        return true;
      bool some = false, all = true;
      for (const types::boundary_id side : seen.sides)
        {
          some = some || holds(given, side);
          all  = all && holds(given, side);
        }
      return (some && !all && seen.angle > blunt * half) ||
             (some && values_disagree(scene, seen, p));
    }
  } // namespace


  template <int dim>
  std::vector<std::vector<Point<dim>>> corners_of_body(const Scene<dim>         &scene,
                                                       const Triangulation<dim> &mesh)
  {
    std::vector<std::vector<Point<dim>>> rough;
    if constexpr (dim > 1)
      {
        std::map<CornerKey<dim>, Seen> corners;
        for (const auto &cell : mesh.cell_iterators_on_level(0))
          {
            add_angles(cell, corners);
            for (const unsigned int f : cell->face_indices())
              if (cell->face(f)->at_boundary())
                add_face<dim>(cell, f, corners);
          }
        for (const auto &[key, seen] : corners)
          {
            std::vector<Point<dim>> ends;
            Point<dim>              middle;
            for (const unsigned int v : key)
              {
                ends.push_back(mesh.get_vertices()[v]);
                middle += 1. / key.size() * Tensor<1, dim>(ends.back());
              }
            if (is_rough(scene, seen, middle))
              rough.push_back(ends);
          }
      }
    return rough;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(corners_of_body);
} // namespace PeriDeal
