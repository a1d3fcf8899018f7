// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "value_lifting.h"

#include <perideal/base/instantiate.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  ValueLifting<dim>::ValueLifting(const FluxMesh<dim> &mesh, GivenValue<dim> given)
    : mesh(mesh)
    , value(std::move(given))
  {
    if (!value)
      return;
    const FiniteElement<dim> &fe    = mesh.dofs().get_fe();
    const auto               &nodes = mesh.unit.lifting_element.get_unit_support_points();
    shapes.resize(fe.n_dofs_per_cell(), nodes.size());
    for (unsigned int i = 0; i < shapes.rows(); ++i)
      for (unsigned int k = 0; k < nodes.size(); ++k)
        shapes(i, k) = fe.shape_value(i, nodes[k]);
    for (const auto &cell : mesh.dofs().active_cell_iterators())
      if (!cell->is_artificial() && cell->at_boundary())
        for (const unsigned int f : cell->face_indices())
          if (cell->at_boundary(f))
            {
              const MappedPoints<dim> at(mesh.unit.on_faces[f], corners_of<dim>(cell));
              const auto              side = cell->face(f)->boundary_id();
              if (has_value(value, side, at))
                {
                  if constexpr (dim == 3)
                    for (unsigned int l = 0; l < 4; ++l)
                      lines.emplace(cell->face(f)->line_index(l), side);
                }
              else
                cut = cut || (cell->is_locally_owned() &&
                              std::any_of(at.points.begin(), at.points.end(), [&](const auto &p) {
                                return value(side, p).has_value();
                              }));
            }
  }


  /** Call visit(is_there, side) with what tells whether a point of the unit cell is on a side. */
  template <int dim>
  template <typename Visit>
  void ValueLifting<dim>::for_each_side(const Cell &cell, const Visit &visit) const
  {
    for (const unsigned int f : cell->face_indices())
      if (cell->at_boundary(f))
        {
          const MappedPoints<dim> at(mesh.unit.on_faces[f], corners_of<dim>(cell));
          const auto              side = cell->face(f)->boundary_id();
          if (has_value(value, side, at))
            visit([f](const Point<dim> &p) { return p[f / 2] == double(f % 2); }, side);
        }
    if constexpr (dim == 3)
      for (unsigned int l = 0; l < GeometryInfo<3>::lines_per_cell; ++l)
        if (const auto found = lines.find(cell->line_index(l)); found != lines.end())
          {
            const Point<3> a =
              GeometryInfo<3>::unit_cell_vertex(GeometryInfo<3>::line_to_cell_vertices(l, 0));
            const Point<3> b =
              GeometryInfo<3>::unit_cell_vertex(GeometryInfo<3>::line_to_cell_vertices(l, 1));
            visit(
              [a, b](const Point<3> &p) {
                for (unsigned int d = 0; d < 3; ++d)
                  if (a[d] == b[d] && p[d] != a[d])
                    return false;
                return true;
              },
              found->second);
          }
  }


  template <int dim>
  Eigen::VectorXd ValueLifting<dim>::numbers(const Cell &cell, const Eigen::VectorXd &of_u) const
  {
    Eigen::VectorXd result, of_solution;
    if (dim == 1 || (dim == 2 && !cell->at_boundary()) || !value)
      return result;
    const auto            &nodes   = mesh.unit.lifting_element.get_unit_support_points();
    const CellCorners<dim> corners = corners_of<dim>(cell);
    std::vector<char>      done(nodes.size(), 0);
    double                 largest = 0.;
    for_each_side(cell, [&](const auto &is_there, const types::boundary_id side) {
      if (result.size() == 0)
        {
          result      = Eigen::VectorXd::Zero(nodes.size());
          of_solution = shapes.transpose() * of_u;
        }
      for (unsigned int k = 0; k < nodes.size(); ++k)
        if (is_there(nodes[k]))
          {
            Point<dim> p;
            for (unsigned int v = 0; v < corners.size(); ++v)
              p += GeometryInfo<dim>::d_linear_shape_function(nodes[k], v) * corners[v];
            const std::optional<double> there = value(side, p);
            if (!there)
              continue;
            const double more = *there - of_solution[k];
            // Where sides with values meet, the solution has one of them.
            if (!done[k] || std::abs(more) < std::abs(result[k]))
              result[k] = more;
            done[k] = 1;
            largest = std::max(largest, std::abs(*there));
          }
    });
    if (result.size() > 0 && result.cwiseAbs().maxCoeff() <= 1e-13 * largest)
      result.resize(0);
    return result;
  }


  template <int dim>
  Eigen::MatrixXd ValueLifting<dim>::gradient(const Eigen::VectorXd &numbers) const
  {
    Eigen::MatrixXd result(dim, mesh.unit.inside.weights.size());
    for (unsigned int d = 0; d < dim; ++d)
      result.row(d) = numbers.transpose() * mesh.unit.lifting.shape_gradients[d];
    return result;
  }


  template <int dim>
  Eigen::VectorXd ValueLifting<dim>::values_on_face(const Eigen::VectorXd &numbers,
                                                    const unsigned int     face) const
  {
    const Eigen::MatrixXd &hats = mesh.unit.on_faces[face].hats;
    Eigen::VectorXd        result(hats.cols());
    for (unsigned int q = 0; q < result.size(); ++q)
      {
        Point<dim> p;
        for (unsigned int v = 0; v < hats.rows(); ++v)
          p += hats(v, q) * GeometryInfo<dim>::unit_cell_vertex(v);
        result[q] = 0.;
        for (unsigned int i = 0; i < numbers.size(); ++i)
          result[q] += numbers[i] * mesh.unit.lifting_element.shape_value(i, p);
      }
    return result;
  }


  PERIDEAL_INSTANTIATE_CLASS(class ValueLifting);
} // namespace PeriDeal
