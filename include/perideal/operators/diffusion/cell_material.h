// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/lac/full_matrix.h>

#include <perideal/base/types.h>
#include <perideal/scene/expression.h>
#include <perideal/scene/material.h>

#include <vector>

namespace PeriDeal
{
  /**
   * Conductivity kappa and capacity rho c in the cells of finite elements, by quadrature. Where
   * they depend on the temperature it is that of the last take(), before the first one the initial
   * value.
   *
   * The arguments of the constructor must outlive this.
   */
  template <int dim>
  class CellMaterial
  {
  public:
    using Cell = typename dealii::DoFHandler<dim>::active_cell_iterator;

    /**
     * @param steady nothing is stored: rho c is 1, which only sets a scale
     *
     * Throws UserError for values that are not positive. Collective.
     */
    CellMaterial(const dealii::DoFHandler<dim> &dofs,
                 const Material                &material,
                 const Expression              &initial_value,
                 const bool                     steady);

    /** Be the material of temperatures. Collective. */
    void take(const Vector &u);

    /** Those of the last take(), with ghosts. */
    const Vector &temperatures_taken() const
    {
      return taken;
    }

    /**
     * Set the matrices of a whole cell: int kappa grad N_i . grad N_j and int rho c N_i N_j. Not
     * collective.
     */
    void assemble(const Cell                 &cell,
                  dealii::FullMatrix<double> &stiffness,
                  dealii::FullMatrix<double> &mass) const;

    /** Set the stiffness of a whole cell of conductivity 1. Not collective. */
    void assemble_unit(const Cell &cell, dealii::FullMatrix<double> &stiffness) const;

    /** Whether kappa is another one at other places or temperatures. Not collective. */
    bool varies() const;

    /** kappa at a point of a cell, at the temperature of one of its vertices. Not collective. */
    double conductivity(const Cell               &cell,
                        const dealii::Point<dim> &p,
                        const unsigned int        vertex) const;

    /** kappa at the centre of a cell of this process or a ghost. Not collective. */
    double center_conductivity(const Cell &cell) const;

    /**
     * y = what each unknown takes up from the temperatures u to v, whatever take() was given;
     * hanging nodes keep theirs.
     * @param lumped by the change of each unknown, else by that of the field
     *
     * Collective.
     */
    void heat_between(Vector &y, const Vector &u, const Vector &v, const bool lumped) const;

    /** Heat in this process's cells: the integral of rho c over the temperature from 0 on. */
    double content(const Vector &u) const;

  private:
    void check() const;
    void find_temperatures() const;

    const dealii::DoFHandler<dim> &dofs;
    const Material                &material;
    const Expression              &initial_value;
    const bool                     steady;
    Vector                         taken; // with ghosts; empty: initial values

    // Scratch memory of the cell loops; temperatures at quadrature points.
    mutable dealii::FEValues<dim>                        values;
    mutable std::vector<dealii::types::global_dof_index> indices;
    mutable std::vector<double>                          temperatures, after;
  };
} // namespace PeriDeal
