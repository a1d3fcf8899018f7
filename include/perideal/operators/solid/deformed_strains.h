// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <perideal/laws/stress_law.h>
#include <perideal/operators/solid/projected_strains.h>

#include <vector>

namespace PeriDeal
{
  /**
   * Strains of Green and Lagrange at the Gauss points of one cell of finite elements Qp that is
   * deformed much, as three-dimensional tensors, and their derivatives. With F = 1 + grad u and J =
   * det F the volume of a body that hardly changes it would lock, so that J is projected: strains
   * are those of
   *
   *     F_bar = (J_bar/J)^(1/3) F,  E = (F_bar^T F_bar - 1)/2,
   *
   * J_bar being J as CellProjection has it (the mean dilatation of Simo, Taylor and Pister 1985).
   * Forces are the derivatives of what a law stores of E, so that they have an energy and the
   * tangent is symmetric; both are those of ProjectedStrains where displacements are small. The
   * stretch out of a plane of strain is (J_bar/J)^(1/3). Not collective.
   */
  template <int dim>
  class DeformedStrains
  {
  public:
    using Strain = dealii::SymmetricTensor<2, 3>;

    /** @param projects else F_bar is F, as in plane stress */
    DeformedStrains(const dealii::FiniteElement<dim> &fe,
                    const unsigned int                n_points,
                    const bool                        projects);

    /**
     * @param values       to outlive what is asked
     * @param u            of the cell, dim components of each node
     * @param with_slopes  of_unknown() and add_geometric() follow
     */
    void reinit(const dealii::FEValues<dim>  &values,
                const dealii::Vector<double> &u,
                const bool                    with_slopes);

    /** The smaller one of J and J_bar. Where it is not positive all that follows means nothing. */
    double volume_ratio(const unsigned int q) const;

    const Strain &strain(const unsigned int q) const
    {
      return points[q].strain;
    }

    /** F_bar - 1, with what is out of the plane. */
    dealii::Tensor<2, 3> displacement_gradient(const unsigned int q) const;

    /** The derivative of the strain by the displacement in direction @p d of a node @p a. */
    Strain of_unknown(const unsigned int a, const unsigned int d, const unsigned int q) const;

    /**
     * Of second stresses of Piola and Kirchhoff at all points the first ones: over the weight of a
     * point the force on a node is that times the gradient of its shape function. (They are those
     * of the projected volume: F S only where nothing is projected.)
     */
    void find_nominal(std::vector<dealii::Tensor<2, dim>> &nominal,
                      const std::vector<Strain>           &stresses) const;

    /**
     * Add the second derivatives of strains times stresses.
     * @param stresses of points, times their weights: those of FEValues, or a share of them
     */
    void add_geometric(dealii::FullMatrix<double> &matrix,
                       const std::vector<Strain>  &stresses) const;

    /** Cauchy's stress. */
    Strain cauchy(const unsigned int q, const StressLaw::Response &response) const;

    /** stiffening_of(), without the projection. */
    double stiffening(const unsigned int q) const;

  private:
    using Vector = dealii::Tensor<1, dim>;
    using Matrix = dealii::Tensor<2, dim>;

    struct Deformed
    {
      Matrix gradient, inverse; // grad u, F^-1
      double change   = 0.;     // J - 1
      double mean     = 0.;     // J_bar - 1
      double log_size = 0.;     // of (J_bar/J)^(2/3)
      Strain strain;
    };

    std::size_t place(const unsigned int a, const unsigned int q) const
    {
      return q * values->dofs_per_cell + a;
    }

    void find_slopes();

    /** What a node has in the geometric stiffness of a point. */
    struct Geometric
    {
      Vector of_stress, along; // S grad_a, F S grad_a
      Vector beside;           // of ln (J_bar/J)
    };

    const bool                   projects;
    CellProjection<dim>          projection;
    const dealii::FEValues<dim> *values = nullptr;
    std::vector<Deformed>        points;
    std::vector<Vector>          slopes; // F^-T grad_a: of ln J
    std::vector<Vector>          means;  // of ln J_bar
  };
} // namespace PeriDeal
