// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/partitioner.h>
#include <deal.II/dofs/dof_handler.h>

#include <perideal/base/types.h>

#include <memory>

namespace PeriDeal
{
  /** The same cell with the unknowns of other elements. */
  template <int dim>
  typename dealii::DoFHandler<dim>::active_cell_iterator same_cell(
    const typename dealii::DoFHandler<dim>::active_cell_iterator &cell,
    const dealii::DoFHandler<dim>                                &dofs)
  {
    return {&dofs.get_triangulation(), cell->level(), cell->index(), &dofs};
  }


  /** A copy with the ghosts of a layout that owns the same unknowns. Collective. */
  inline Vector with_ghosts(
    const Vector                                                     &v,
    const std::shared_ptr<const dealii::Utilities::MPI::Partitioner> &layout)
  {
    Vector copy(layout);
    copy.copy_locally_owned_data_from(v);
    copy.update_ghost_values();
    return copy;
  }
} // namespace PeriDeal
