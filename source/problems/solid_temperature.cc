// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "solid_temperature.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void find_temperature_change(const DiffusionProblem<dim> &heat,
                               const SolidProblem<dim>     &elastic,
                               const double                 reference,
                               Vector                      &change)
  {
    const DoFHandler<dim> &from = heat.dofs(), &to = elastic.dofs();
    AssertDimension(from.get_fe().n_dofs_per_cell(), to.get_fe().n_dofs_per_cell());
    std::vector<types::global_dof_index> source(from.get_fe().n_dofs_per_cell()), target(source);
    const auto                          &owned = *change.get_partitioner();
    auto                                 cell  = to.begin_active();
    for (const auto &of_heat : from.active_cell_iterators())
      {
        if (cell->is_locally_owned())
          {
            of_heat->get_dof_indices(source);
            cell->get_dof_indices(target);
            for (unsigned int i = 0; i < source.size(); ++i)
              if (owned.in_local_range(target[i]))
                change(target[i]) = heat.solution(source[i]) - reference;
          }
        ++cell;
      }
  }


#define PERIDEAL_INSTANTIATE(dim)                                      \
  template void find_temperature_change(const DiffusionProblem<dim> &, \
                                        const SolidProblem<dim> &,     \
                                        const double,                  \
                                        Vector &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
