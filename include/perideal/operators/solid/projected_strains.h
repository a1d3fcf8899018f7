// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/polynomial_space.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <vector>

namespace PeriDeal
{
  /**
   * Numbers at the Gauss points of one cell of finite elements Qp replaced by the polynomial of
   * degree p - 1 in the coordinates that is nearest to them in the mean square over the cell: their
   * mean for p = 1, a linear function for p = 2. Not collective.
   */
  template <int dim>
  class CellProjection
  {
  public:
    CellProjection(const dealii::FiniteElement<dim> &fe, const unsigned int n_points);

    /** @param values of the cell, with its quadrature points and weights; to outlive projections */
    void reinit(const dealii::FEValues<dim> &values);

    /** @param of the number at a point */
    template <typename Number, typename At>
    void find(std::vector<Number> &projected, const At &of) const
    {
      const unsigned int  n = polynomials.n();
      std::vector<Number> moments(n), coefficients(n);
      for (unsigned int k = 0; k < n; ++k)
        for (unsigned int q = 0; q < basis.size(); ++q)
          moments[k] += basis[q][k] * weights[q] * of(q);
      for (unsigned int k = 0; k < n; ++k)
        for (unsigned int l = 0; l < n; ++l)
          coefficients[k] += inverse(k, l) * moments[l];
      projected.assign(basis.size(), Number());
      for (unsigned int q = 0; q < basis.size(); ++q)
        for (unsigned int k = 0; k < n; ++k)
          projected[q] += basis[q][k] * coefficients[k];
    }

  private:
    const dealii::PolynomialSpace<dim> polynomials;
    std::vector<std::vector<double>>   basis; // by point
    std::vector<double>                weights;
    dealii::FullMatrix<double>         inverse;
  };


  /**
   * Strains at the Gauss points of one cell of finite elements Qp, as three-dimensional tensors. A
   * body that flows keeps its volume, which the dilatations of all (p + 1)^dim points together
   * would not let it do (locking). So these are projected (B-bar): in
   *
   *     eps = sym(grad u) + (theta_bar - div u)/3 I,
   *
   * theta_bar is div u as CellProjection has it. These are the elements Q1/P0 and Q2/P1 of a
   * pressure that is discontinuous. Strains that are uniform stay as they are. The change out of a
   * plane of strain belongs to it. Not collective.
   */
  template <int dim>
  class ProjectedStrains
  {
  public:
    using Cell   = typename dealii::DoFHandler<dim>::active_cell_iterator;
    using Strain = dealii::SymmetricTensor<2, 3>;

    /** @param projects else dilatations stay what they are, as in plane stress */
    ProjectedStrains(const dealii::FiniteElement<dim> &fe, const bool projects);

    void reinit(const Cell &cell);

    /** Shape functions, their gradients, points, and weights of QGauss(p + 1). */
    const dealii::FEValues<dim> &values() const
    {
      return of_cell;
    }

    /** @param u of the cell, dim components of each node */
    Strain strain(const unsigned int q, const dealii::Vector<double> &u) const;

    /** Dilatations at the points, or thirds of them, become what they are in strain(). */
    void project(std::vector<double> &values) const
    {
      const std::vector<double> given = values;
      if (projects)
        projection.find(values, [&](const unsigned int q) { return given[q]; });
    }

    /** The strain that a displacement of one in direction @p d of a node @p a makes. */
    Strain of_unknown(const unsigned int a, const unsigned int d, const unsigned int q) const;

    /**
     * The force on a node @p a that a stress at a point makes, over its weight: the derivative of
     * stress : strain by the displacement of the node.
     */
    dealii::Tensor<1, dim> force(const unsigned int a,
                                 const unsigned int q,
                                 const Strain      &stress) const;

  private:
    /** theta_bar of displacements of node a. */
    const dealii::Tensor<1, dim> &mean_gradient(const unsigned int a, const unsigned int q) const
    {
      return means[q * of_cell.dofs_per_cell + a];
    }

    const bool                          projects;
    dealii::FEValues<dim>               of_cell;
    CellProjection<dim>                 projection;
    std::vector<dealii::Tensor<1, dim>> means;
  };
} // namespace PeriDeal
