// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Hanging nodes of graded meshes.

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>

#include <perideal/operators/fem_operator.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void FEMOperator<dim>::find_hanging()
  {
    if (dofs.get_triangulation().has_hanging_nodes())
      {
        IndexSet relevant;
        DoFTools::extract_locally_relevant_dofs(dofs, relevant);
        constraints.reinit(relevant);
        DoFTools::make_hanging_node_constraints(dofs, constraints);
      }
    constraints.close();
    any_hanging =
      Utilities::MPI::max(constraints.n_constraints() > 0 ? 1 : 0, dofs.get_communicator()) > 0;
    if (!any_hanging)
      return;
    Vector layout;
    initialize_vector(layout);
    const auto &numbers = *layout.get_partitioner();
    for (const auto &line : constraints.get_lines())
      if (numbers.in_local_range(line.index))
        {
          HangingNode node{numbers.global_to_local(line.index), {}};
          for (const auto &[master, weight] : line.entries)
            node.masters.emplace_back(numbers.global_to_local(master), weight);
          hanging.push_back(std::move(node));
        }
    std::sort(hanging.begin(), hanging.end(), [](const HangingNode &a, const HangingNode &b) {
      return a.dof < b.dof;
    });
  }


  template <int dim>
  void FEMOperator<dim>::add_to(TrilinosWrappers::SparseMatrix             &matrix,
                                const FullMatrix<double>                   &of_cell,
                                const std::vector<types::global_dof_index> &indices) const
  {
    if (any_hanging && std::any_of(indices.begin(), indices.end(), [&](const auto i) {
          return constraints.is_constrained(i);
        }))
      constraints.distribute_local_to_global(of_cell, indices, matrix);
    else
      matrix.add(indices, of_cell);
  }


  template <int dim>
  void FEMOperator<dim>::condense(Vector &loads) const
  {
    if (!any_hanging)
      return;
    loads.zero_out_ghost_values();
    for (const HangingNode &node : hanging)
      {
        for (const auto &[master, weight] : node.masters)
          loads.local_element(master) += weight * loads.local_element(node.dof);
        loads.local_element(node.dof) = 0.;
      }
    loads.compress(VectorOperation::add);
  }


  template <int dim>
  void FEMOperator<dim>::interpolate_hanging(Vector &v) const
  {
    if (!any_hanging)
      return;
    v.update_ghost_values();
    for (const HangingNode &node : hanging)
      {
        double value = 0.;
        for (const auto &[master, weight] : node.masters)
          value += weight * v.local_element(master);
        v.local_element(node.dof) = value;
      }
    v.set_ghost_state(false);
  }


  template <int dim>
  void FEMOperator<dim>::set_hanging(Vector &v, const double value) const
  {
    for (const HangingNode &node : hanging)
      v.local_element(node.dof) = value;
  }


#define PERIDEAL_INSTANTIATE(dim)                                                             \
  template void FEMOperator<dim>::find_hanging();                                             \
  template void FEMOperator<dim>::add_to(TrilinosWrappers::SparseMatrix &,                    \
                                         const FullMatrix<double> &,                          \
                                         const std::vector<types::global_dof_index> &) const; \
  template void FEMOperator<dim>::condense(Vector &) const;                                   \
  template void FEMOperator<dim>::interpolate_hanging(Vector &) const;                        \
  template void FEMOperator<dim>::set_hanging(Vector &, const double) const;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
