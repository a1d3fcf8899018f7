// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/partitioner.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/mapping_q1.h>

#include <memory>
#include <vector>

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


  /**
   * Call visit(dof, place) for what cells of this process and around it have, once for each of its
   * cells. Not collective.
   */
  template <int dim, typename Visit>
  void for_each_support_point(const dealii::DoFHandler<dim> &dofs, const Visit &visit)
  {
    const dealii::MappingQ1<dim>                 mapping;
    const auto                                  &element = dofs.get_fe();
    std::vector<dealii::types::global_dof_index> indices(element.n_dofs_per_cell());
    for (const auto &cell : dofs.active_cell_iterators())
      if (!cell->is_artificial())
        {
          cell->get_dof_indices(indices);
          for (unsigned int i = 0; i < indices.size(); ++i)
            visit(indices[i],
                  mapping.transform_unit_to_real_cell(cell, element.unit_support_point(i)));
        }
  }
} // namespace PeriDeal
