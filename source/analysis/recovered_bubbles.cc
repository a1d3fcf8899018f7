// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Second derivatives of a field of bilinear elements, and what they add in the middles of edges,
// faces and cells.

#include <deal.II/dofs/dof_accessor.h>

#include <perideal/analysis/quadratic_elements.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>

#include "element_vectors.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** Powers of the coordinates up to the second: 1, x_a, x_a x_b with a <= b. */
    template <int dim>
    constexpr unsigned int n_monomials = 1 + dim + dim *(dim + 1) / 2;


    template <int dim>
    Eigen::Matrix<double, n_monomials<dim>, 1> monomials(const Tensor<1, dim> &x)
    {
      Eigen::Matrix<double, n_monomials<dim>, 1> m;
      unsigned int                               k = 0;
      m[k++]                                       = 1.;
      for (unsigned int a = 0; a < dim; ++a)
        m[k++] = x[a];
      for (unsigned int a = 0; a < dim; ++a)
        for (unsigned int b = a; b < dim; ++b)
          m[k++] = x[a] * x[b];
      return m;
    }


    /** The normal equations of a quadratic polynomial of the coordinates relative to a vertex. */
    template <int dim>
    struct Fit
    {
      static constexpr unsigned int n      = n_monomials<dim>;
      Eigen::Matrix<double, n, n>   matrix = Eigen::Matrix<double, n, n>::Zero();
      Eigen::Matrix<double, n, 1>   loads  = Eigen::Matrix<double, n, 1>::Zero();

      void add(const Tensor<1, dim> &x, const double value)
      {
        const auto m = monomials<dim>(x);
        matrix.noalias() += m * m.transpose();
        loads += value * m;
      }

      /** The coefficients of the second powers; false where the points do not determine them. */
      bool solve(std::array<double, n - 1 - dim> &second) const
      {
        // Monomials of length one. The smallest eigenvalue is 0.2 with all neighbours of a lattice,
        // 0 with two rows of it.
        constexpr double                  least = 0.03;
        const Eigen::Matrix<double, n, 1> scale = matrix.diagonal().cwiseSqrt().cwiseInverse();
        if (!scale.allFinite())
          return false;
        const Eigen::Matrix<double, n, n> scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, n, n>> solver(
          scaled,
          Eigen::EigenvaluesOnly);
        if (solver.eigenvalues()[0] < least)
          return false;
        const Eigen::Matrix<double, n, 1> coefficients =
          scale.cwiseProduct(scaled.ldlt().solve(scale.cwiseProduct(loads)));
        for (unsigned int k = 0; k < second.size(); ++k)
          second[k] = coefficients[1 + dim + k];
        return true;
      }
    };
  } // namespace


  /** Call visit(i) for owned unknowns that are free, of bubbles. */
  template <int dim>
  template <typename Visit>
  void QuadraticElements<dim>::for_each_bubble(const Visit &visit) const
  {
    for (unsigned int i = 0; i < vertex.size(); ++i)
      if (!vertex[i] && !held[i] && left_out.local_element(i) == 0.)
        visit(i);
  }


  /**
   * By vertex, with ghosts: the coefficients of x_a x_b, and at last whether they are known. Not
   * where the cells around are of several materials, or too few.
   */
  template <int dim>
  std::vector<Vector> QuadraticElements<dim>::second_derivatives(const Vector &v) const
  {
    const DoFHandler<dim> &dofs = op.dof_handler();
    std::vector<Cell>      cells;
    for (const auto &cell : dofs.active_cell_iterators())
      if (!cell->is_artificial() && !is_left_out(cell))
        cells.push_back(cell);
    std::vector<std::vector<unsigned int>> around(linear_layout->locally_owned_size());
    for (unsigned int c = 0; c < cells.size(); ++c)
      for (const unsigned int k : cells[c]->vertex_indices())
        if (const auto dof = cells[c]->vertex_dof_index(k, 0);
            linear_layout->in_local_range(dof) && !op.hanging_nodes().is_hanging(dof))
          around[linear_layout->global_to_local(dof)].push_back(c);
    std::vector<Vector>                       second(Fit<dim>::n - dim, Vector(linear_layout));
    std::array<double, Fit<dim>::n - 1 - dim> coefficients;
    for (unsigned int i = 0; i < around.size(); ++i)
      {
        if (around[i].empty())
          continue;
        Fit<dim>   fit;
        bool       one_material = true;
        Point<dim> middle;
        for (const unsigned int k : cells[around[i][0]]->vertex_indices())
          if (cells[around[i][0]]->vertex_dof_index(k, 0) == linear_layout->local_to_global(i))
            middle = cells[around[i][0]]->vertex(k);
        for (const unsigned int c : around[i])
          {
            one_material = one_material &&
                           cells[c]->material_id() == cells[around[i][0]]->material_id();
            for (const unsigned int k : cells[c]->vertex_indices())
              if (const auto dof = cells[c]->vertex_dof_index(k, 0);
                  !op.hanging_nodes().is_hanging(dof))
                fit.add(cells[c]->vertex(k) - middle, v(dof));
          }
        if (!one_material || !fit.solve(coefficients))
          continue;
        for (unsigned int k = 0; k < coefficients.size(); ++k)
          second[k].local_element(i) = coefficients[k];
        second.back().local_element(i) = 1.;
      }
    for (Vector &component : second)
      component.update_ghost_values();
    return second;
  }


  template <int dim>
  Vector QuadraticElements<dim>::recovered_bubbles(const Vector &v) const
  {
    const std::vector<Vector>            second = second_derivatives(with_ghosts(v, linear_layout));
    const unsigned int                   n_second = second.size() - 1;
    Vector                               w(layout), n_cells(layout);
    std::vector<types::global_dof_index> indices(prolongation.m());
    std::vector<double>                  sum(n_second);
    for (const auto &cell : op.dof_handler().active_cell_iterators())
      if (cell->is_locally_owned() && !is_left_out(cell))
        {
          same_cell(cell, *quadratic)->get_dof_indices(indices);
          // Mean of what is known at some of the vertices; returns whether there is any.
          const auto mean = [&](const auto &takes_part) {
            double n = 0.;
            sum.assign(n_second, 0.);
            for (const unsigned int k : cell->vertex_indices())
              if (const auto dof = cell->vertex_dof_index(k, 0);
                  takes_part(k) && second.back()(dof) > 0.)
                {
                  n += 1.;
                  for (unsigned int s = 0; s < n_second; ++s)
                    sum[s] += second[s](dof);
                }
            for (double &s : sum)
              s /= std::max(n, 1.);
            return n > 0.;
          };
          for (unsigned int i = cell->n_vertices(); i < indices.size(); ++i)
            {
              const auto is_end = [&](const unsigned int k) { return prolongation(i, k) > 0.; };
              if (!mean(is_end) && !mean([](const unsigned int) { return true; }))
                continue;
              Point<dim> middle;
              for (const unsigned int k : cell->vertex_indices())
                middle += prolongation(i, k) * cell->vertex(k);
              double bubble = 0.;
              for (const unsigned int k : cell->vertex_indices())
                if (is_end(k))
                  {
                    const Tensor<1, dim> x = cell->vertex(k) - middle;
                    unsigned int         s = 0;
                    for (unsigned int a = 0; a < dim; ++a)
                      for (unsigned int b = a; b < dim; ++b)
                        bubble -= prolongation(i, k) * sum[s++] * x[a] * x[b];
                  }
              w(indices[i]) += bubble;
              n_cells(indices[i]) += 1.;
            }
        }
    w.compress(VectorOperation::add);
    n_cells.compress(VectorOperation::add);
    Vector bubbles(layout);
    for_each_bubble([&](const unsigned int i) {
      if (n_cells.local_element(i) > 0.)
        bubbles.local_element(i) = w.local_element(i) / n_cells.local_element(i);
    });
    hanging.interpolate(bubbles);
    return bubbles;
  }


#define PERIDEAL_INSTANTIATE(dim) \
  template Vector QuadraticElements<dim>::recovered_bubbles(const Vector &) const;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
