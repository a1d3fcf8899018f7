// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/interleaved.h>
#include <perideal/operators/parts/hanging_nodes.h>

#include <algorithm>
#include <map>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** Lines of nodes as lines of all of their components. */
    template <int dim>
    void make_lines(const DoFHandler<dim>     &dofs,
                    const unsigned int         n_components,
                    AffineConstraints<double> &lines)
    {
      IndexSet relevant;
      DoFTools::extract_locally_relevant_dofs(dofs, relevant);
      AffineConstraints<double> of_nodes(relevant);
      DoFTools::make_hanging_node_constraints(dofs, of_nodes);
      of_nodes.close(); // masters that hang themselves are replaced by theirs
      lines.reinit(interleaved(relevant, n_components));
      for (const auto &line : of_nodes.get_lines())
        for (unsigned int c = 0; c < n_components; ++c)
          {
            lines.add_line(n_components * line.index + c);
            for (const auto &[master, weight] : line.entries)
              lines.add_entry(n_components * line.index + c, n_components * master + c, weight);
          }
    }
  } // namespace


  template <int dim>
  HangingNodes<dim>::HangingNodes(const DoFHandler<dim>             &dofs,
                                  const Utilities::MPI::Partitioner &layout,
                                  const unsigned int                 n_components)
  {
    if (dofs.get_triangulation().has_hanging_nodes())
      make_lines(dofs, n_components, lines);
    lines.close();
    on_any_process =
      Utilities::MPI::max(lines.n_constraints() > 0 ? 1 : 0, dofs.get_communicator()) > 0;
    const auto local = [&](const types::global_dof_index unknown) {
      return n_components * layout.global_to_local(unknown / n_components) + unknown % n_components;
    };
    std::map<unsigned int, std::vector<std::pair<unsigned int, double>>> found;
    for (const auto &line : lines.get_lines())
      if (layout.in_local_range(line.index / n_components))
        {
          auto &list = found[local(line.index)];
          for (const auto &[master, weight] : line.entries)
            list.emplace_back(local(master), weight);
        }
    for (auto &[unknown, list] : found)
      {
        unknowns.push_back(unknown);
        masters.push_back(std::move(list));
      }
  }


  template <int dim>
  void HangingNodes<dim>::let_follow(
    const std::vector<std::pair<unsigned int, unsigned int>> &pairs,
    const MPI_Comm                                            communicator)
  {
    for (const auto &[unknown, master] : pairs)
      {
        const auto place = std::lower_bound(unknowns.begin(), unknowns.end(), unknown);
        masters.insert(masters.begin() + (place - unknowns.begin()), {{master, 1.}});
        unknowns.insert(place, unknown);
      }
    on_any_process = Utilities::MPI::max(unknowns.empty() ? 0 : 1, communicator) > 0 ||
                     on_any_process;
  }


  template <int dim>
  bool HangingNodes<dim>::is_hanging(const types::global_dof_index unknown) const
  {
    return on_any_process && lines.is_constrained(unknown);
  }


  template <int dim>
  void HangingNodes<dim>::add_to(TrilinosWrappers::SparsityPattern          &pattern,
                                 const std::vector<types::global_dof_index> &indices) const
  {
    if (std::any_of(indices.begin(), indices.end(), [&](const auto i) { return is_hanging(i); }))
      lines.add_entries_local_to_global(indices, pattern, false);
    else
      for (const auto row : indices)
        pattern.add_entries(row, indices.begin(), indices.end());
  }


  template <int dim>
  void HangingNodes<dim>::condense(Vector &loads) const
  {
    if (!on_any_process)
      return;
    loads.zero_out_ghost_values();
    for (std::size_t k = 0; k < unknowns.size(); ++k)
      {
        for (const auto &[master, weight] : masters[k])
          loads.local_element(master) += weight * loads.local_element(unknowns[k]);
        loads.local_element(unknowns[k]) = 0.;
      }
    loads.compress(VectorOperation::add);
  }


  template <int dim>
  void HangingNodes<dim>::interpolate(Vector &v) const
  {
    if (!on_any_process)
      return;
    v.update_ghost_values();
    for (std::size_t k = 0; k < unknowns.size(); ++k)
      {
        double value = 0.;
        for (const auto &[master, weight] : masters[k])
          value += weight * v.local_element(master);
        v.local_element(unknowns[k]) = value;
      }
    v.set_ghost_state(false);
  }


  template <int dim>
  void HangingNodes<dim>::set(Vector &v, const double value) const
  {
    for (const unsigned int unknown : unknowns)
      v.local_element(unknown) = value;
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


  PERIDEAL_INSTANTIATE_CLASS(class HangingNodes);
} // namespace PeriDeal
