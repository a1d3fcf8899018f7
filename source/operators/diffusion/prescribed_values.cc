// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/fe/mapping_q1.h>

#include <perideal/base/instantiate.h>
#include <perideal/operators/diffusion/prescribed_values.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** Call visit(k, dof, place) for the unknowns on sides that the k-th condition holds. */
    template <int dim, typename Visit>
    void for_each_on_sides(const DoFHandler<dim>         &dofs,
                           const BoundaryConditions<dim> &conditions,
                           const Visit                   &visit)
    {
      const auto                          &fe = dofs.get_fe();
      std::vector<types::global_dof_index> indices(fe.n_dofs_per_cell());
      for (const auto &cell : dofs.active_cell_iterators())
        {
          if (cell->is_artificial() || !cell->at_boundary())
            continue;
          cell->get_dof_indices(indices);
          for (const unsigned int f : cell->face_indices())
            for (unsigned int k = 0; k < conditions.dirichlet.size(); ++k)
              {
                const auto id = conditions.dirichlet[k].id;
                if (!cell->face(f)->at_boundary() ||
                    conditions.side_of(id) != cell->face(f)->boundary_id())
                  continue;
                for (unsigned int i = 0; i < indices.size(); ++i)
                  if (fe.has_support_on_face(i, f))
                    {
                      const Point<dim> p =
                        MappingQ1<dim>().transform_unit_to_real_cell(cell,
                                                                     fe.unit_support_point(i));
                      if (conditions.holds_at(id, p))
                        visit(k, indices[i], p);
                    }
              }
        }
    }
  } // namespace


  template <int dim>
  PrescribedValues<dim>::PrescribedValues(const DoFHandler<dim>               &dofs,
                                          const Utilities::MPI::Partitioner   &layout,
                                          const BoundaryConditions<dim>       &conditions,
                                          const HangingNodes<dim>             &hanging,
                                          const std::vector<PartUnknown<dim>> &parts)
  {
    const auto &dirichlet = conditions.dirichlet;
    Counts      n_nodes(dirichlet.size(), 0);
    // For each unknown the place in the list of the condition that holds: the one named first.
    std::map<unsigned int, std::pair<unsigned int, Point<dim>>> found;
    const auto                                                  hold =
      [&](const unsigned int k, const types::global_dof_index dof, const Point<dim> &p) {
        if (!layout.in_local_range(dof) || hanging.is_hanging(dof))
          return;
        const auto [entry, is_new] = found.try_emplace(layout.global_to_local(dof), k, p);
        entry->second.first        = std::min(entry->second.first, k);
        ++n_nodes[k];
      };
    for_each_on_sides(dofs, conditions, hold);
    for (const PartUnknown<dim> &unknown : parts)
      for (unsigned int k = 0; k < dirichlet.size(); ++k)
        if (dirichlet[k].id == unknown.id)
          hold(k, layout.local_to_global(unknown.node), unknown.position);
    std::vector<Entry>        list;
    std::vector<unsigned int> prescribed;
    for (const auto &[unknown, entry] : found)
      {
        list.push_back({unknown, entry.second, &dirichlet[entry.first]});
        prescribed.push_back(unknown);
      }
    set_entries(std::move(list),
                conditions,
                n_nodes,
                Counts(dirichlet.size(), 0),
                dofs.get_communicator());
    std::vector<unsigned int> not_free = prescribed;
    not_free.insert(not_free.end(), hanging.owned().begin(), hanging.owned().end());
    std::sort(not_free.begin(), not_free.end());
    this->set_held(std::move(not_free), std::move(prescribed));
  }


  template <int dim>
  void PrescribedValues<dim>::set_entries(std::vector<Entry>             list,
                                          const BoundaryConditions<dim> &conditions,
                                          const Counts                  &n_nodes,
                                          Counts                         n_held,
                                          const MPI_Comm                 communicator)
  {
    with_value = std::move(list);
    for (const Entry &entry : with_value)
      ++n_held[entry.condition - conditions.dirichlet.data()];
    require_held_parts(conditions,
                       conditions.dirichlet,
                       n_nodes,
                       n_held,
                       "Dirichlet",
                       communicator);
    on_any_process = Utilities::MPI::max(with_value.empty() ? 0 : 1, communicator) > 0;
  }


  template <int dim>
  void PrescribedValues<dim>::distribute(Vector &u, const double t) const
  {
    for (const Entry &entry : with_value)
      u.local_element(entry.unknown) = entry.condition->value.value(entry.position, t);
  }


  template <int dim>
  void PrescribedValues<dim>::add_to(std::map<std::string, double> &sides, const Vector &y) const
  {
    for (const Entry &entry : with_value)
      sides[entry.condition->name] += y.local_element(entry.unknown);
  }


  PERIDEAL_INSTANTIATE_CLASS(class PrescribedValues);
} // namespace PeriDeal
