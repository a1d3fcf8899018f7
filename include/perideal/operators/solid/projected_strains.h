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
   * Strains at the Gauss points of one cell of finite elements Qp, as three-dimensional tensors. A
   * body that flows keeps its volume, which the dilatations of all (p + 1)^dim points together
   * would not let it do (locking). So these are projected (B-bar): in
   *
   *     eps = sym(grad u) + (theta_bar - div u)/3 I,
   *
   * theta_bar is the polynomial of degree p - 1 in the coordinates that is nearest to div u in the
   * mean square over the cell: its mean for p = 1, a linear function for p = 2. These are the
   * elements Q1/P0 and Q2/P1 of a pressure that is discontinuous. Strains that are uniform stay as
   * they are. The change out of a plane of strain belongs to it. Not collective.
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
    const dealii::PolynomialSpace<dim>  polynomials;
    std::vector<std::vector<double>>    basis; // by point
    dealii::FullMatrix<double>          inverse;
    std::vector<dealii::Tensor<1, dim>> means;
  };
} // namespace PeriDeal
