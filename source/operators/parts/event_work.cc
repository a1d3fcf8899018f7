// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/operators/parts/event_work.h>

#include <algorithm>
#include <limits>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  EventWork<dim>::EventWork(const DoFHandler<dim>           &dofs,
                            const Vector                    &layout,
                            const std::vector<unsigned int> &held_rows)
    : search(dofs)
    , touched(layout)
    , held(layout)
    , factors(layout)
    , bound(layout)
    , layout(layout.get_partitioner())
  {
    for (const unsigned int i : held_rows)
      held.insert(i);
  }


  template <int dim>
  std::vector<typename EventWork<dim>::Cell> EventWork<dim>::cells_near(const Boxes &cuts,
                                                                        const double of_cuts,
                                                                        const Boxes &joins,
                                                                        const double of_joins) const
  {
    std::vector<Cell> near;
    search.find(cuts, of_cuts, near);
    search.find(joins, of_joins, near);
    return near;
  }


  template <int dim>
  void EventWork<dim>::touch(const std::vector<types::global_dof_index> &of_cell,
                             const HangingNodes<dim>                    &hanging)
  {
    for (const auto i : of_cell)
      {
        touched.insert(layout->global_to_local(i));
        if (const auto *masters = hanging.constraints().get_constraint_entries(i))
          for (const auto &master : *masters)
            touched.insert(layout->global_to_local(master.first));
      }
  }


  template <int dim>
  std::vector<unsigned int> owned_unknowns(
    const std::vector<typename DoFHandler<dim>::active_cell_iterator> &cells,
    const Utilities::MPI::Partitioner                                 &layout)
  {
    std::vector<unsigned int>            list;
    std::vector<types::global_dof_index> indices;
    for (const auto &cell : cells)
      {
        indices.resize(cell->get_fe().n_dofs_per_cell());
        cell->get_dof_indices(indices);
        for (const auto i : indices)
          if (layout.in_local_range(i))
            list.push_back(layout.global_to_local(i));
      }
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return list;
  }


  template <int dim>
  std::vector<BoundingBox<dim>> boxes_beside(const std::vector<BoundingBox<dim>> &cuts,
                                             const std::vector<BoundingBox<dim>> &joins,
                                             const MPI_Comm                       communicator)
  {
    std::vector<double> lowest(2 * dim * cuts.size(), std::numeric_limits<double>::max());
    for (const BoundingBox<dim> &join : joins)
      {
        std::size_t nearest = 0;
        for (std::size_t k = 1; k < cuts.size(); ++k)
          if (join.center().distance(cuts[k].center()) <
              join.center().distance(cuts[nearest].center()))
            nearest = k;
        double *const box = lowest.data() + 2 * dim * nearest;
        for (unsigned int d = 0; d < dim; ++d)
          {
            box[d]       = std::min(box[d], join.lower_bound(d));
            box[dim + d] = std::min(box[dim + d], -join.upper_bound(d));
          }
      }
    std::vector<double> all(lowest.size());
    Utilities::MPI::min(lowest, communicator, all);
    std::vector<BoundingBox<dim>> boxes;
    for (const double *box = all.data(); box != all.data() + all.size(); box += 2 * dim)
      if (box[0] < std::numeric_limits<double>::max())
        {
          Point<dim> low, high;
          for (unsigned int d = 0; d < dim; ++d)
            {
              low[d]  = box[d];
              high[d] = -box[dim + d];
            }
          boxes.push_back({{low, high}});
        }
    return boxes;
  }


  PERIDEAL_INSTANTIATE_CLASS(struct EventWork);
  PERIDEAL_INSTANTIATE_FUNCTION(owned_unknowns);
  PERIDEAL_INSTANTIATE_FUNCTION(boxes_beside);
} // namespace PeriDeal
