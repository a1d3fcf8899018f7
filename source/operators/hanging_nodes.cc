// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>

#include <perideal/operators/hanging_nodes.h>

#include <algorithm>
#include <map>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  HangingNodes<dim>::HangingNodes(const DoFHandler<dim>             &dofs,
                                  const Utilities::MPI::Partitioner &layout)
  {
    if (dofs.get_triangulation().has_hanging_nodes())
      {
        IndexSet relevant;
        DoFTools::extract_locally_relevant_dofs(dofs, relevant);
        lines.reinit(relevant);
        DoFTools::make_hanging_node_constraints(dofs, lines);
      }
    lines.close();
    on_any_process =
      Utilities::MPI::max(lines.n_constraints() > 0 ? 1 : 0, dofs.get_communicator()) > 0;
    std::map<unsigned int, std::vector<std::pair<unsigned int, double>>> found;
    for (const auto &line : lines.get_lines())
      if (layout.in_local_range(line.index))
        {
          auto &list = found[layout.global_to_local(line.index)];
          for (const auto &[master, weight] : line.entries)
            list.emplace_back(layout.global_to_local(master), weight);
        }
    for (auto &[node, list] : found)
      {
        nodes.push_back(node);
        masters.push_back(std::move(list));
      }
  }


  template <int dim>
  bool HangingNodes<dim>::any() const
  {
    return on_any_process;
  }


  template <int dim>
  bool HangingNodes<dim>::is_hanging(const types::global_dof_index dof) const
  {
    return on_any_process && lines.is_constrained(dof);
  }


  template <int dim>
  const std::vector<unsigned int> &HangingNodes<dim>::owned() const
  {
    return nodes;
  }


  template <int dim>
  const AffineConstraints<double> &HangingNodes<dim>::constraints() const
  {
    return lines;
  }


  template <int dim>
  void HangingNodes<dim>::condense(Vector &loads) const
  {
    if (!on_any_process)
      return;
    loads.zero_out_ghost_values();
    for (std::size_t k = 0; k < nodes.size(); ++k)
      {
        for (const auto &[master, weight] : masters[k])
          loads.local_element(master) += weight * loads.local_element(nodes[k]);
        loads.local_element(nodes[k]) = 0.;
      }
    loads.compress(VectorOperation::add);
  }


  template <int dim>
  void HangingNodes<dim>::interpolate(Vector &v) const
  {
    if (!on_any_process)
      return;
    v.update_ghost_values();
    for (std::size_t k = 0; k < nodes.size(); ++k)
      {
        double value = 0.;
        for (const auto &[master, weight] : masters[k])
          value += weight * v.local_element(master);
        v.local_element(nodes[k]) = value;
      }
    v.set_ghost_state(false);
  }


  template <int dim>
  void HangingNodes<dim>::set(Vector &v, const double value) const
  {
    for (const unsigned int node : nodes)
      v.local_element(node) = value;
  }


  template <int dim>
  void HangingNodes<dim>::add_to(TrilinosWrappers::SparseMatrix             &matrix,
                                 const FullMatrix<double>                   &of_cell,
                                 const std::vector<types::global_dof_index> &indices) const
  {
    if (std::any_of(indices.begin(), indices.end(), [&](const auto i) { return is_hanging(i); }))
      lines.distribute_local_to_global(of_cell, indices, matrix);
    else
      matrix.add(indices, of_cell);
  }


  template class HangingNodes<1>;
  template class HangingNodes<2>;
  template class HangingNodes<3>;
} // namespace PeriDeal
