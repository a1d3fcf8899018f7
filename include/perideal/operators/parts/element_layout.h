// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/partitioner.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>

#include <memory>

namespace PeriDeal
{
  /**
   * The layout of vectors of finite elements with one number for each dof: that of the nodes of a
   * coupling, with its horizon-wide halo, or with the locally relevant dofs as ghosts. Collective.
   *
   * @param coupling null: finite elements alone
   */
  template <int dim, typename CouplingType>
  std::shared_ptr<const dealii::Utilities::MPI::Partitioner> element_layout(
    const dealii::DoFHandler<dim> &dofs,
    const CouplingType            *coupling)
  {
    if (coupling != nullptr)
      return coupling->families().nodes().partitioner();
    dealii::IndexSet relevant;
    dealii::DoFTools::extract_locally_relevant_dofs(dofs, relevant);
    return std::make_shared<const dealii::Utilities::MPI::Partitioner>(dofs.locally_owned_dofs(),
                                                                       relevant,
                                                                       dofs.get_communicator());
  }
} // namespace PeriDeal
