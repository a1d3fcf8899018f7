// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/fem_operator.h>

#include "local_bound.h"
#include "row_set.h"

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


  /** Memory of update(), so that an event costs what changes and not what there is. */
  template <int dim>
  struct FEMOperator<dim>::EventData
  {
    explicit EventData(const Vector &layout)
      : touched(layout)
      , held(layout)
      , factors(layout)
      , bound(layout)
    {}

    RowSet                 touched, held; // rows of K that the event changes; that are not free
    CrackSideFactors::Sums factors;
    LocalBound             bound;
  };
} // namespace PeriDeal
