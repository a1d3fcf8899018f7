// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/fem_operator.h>

namespace PeriDeal
{
  /** Scratch memory of the cell loops. */
  template <int dim>
  struct FEMOperator<dim>::CellData
  {
    explicit CellData(const dealii::FiniteElement<dim> &fe)
      : stiffness(fe.n_dofs_per_cell(), fe.n_dofs_per_cell())
      , mass(fe.n_dofs_per_cell(), fe.n_dofs_per_cell())
      , convection(fe.n_dofs_per_cell(), fe.n_dofs_per_cell())
      , indices(fe.n_dofs_per_cell())
    {}

    dealii::FullMatrix<double>                   stiffness, mass, convection;
    std::vector<dealii::types::global_dof_index> indices;
  };
} // namespace PeriDeal
