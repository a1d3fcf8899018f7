// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/partitioner.h>
#include <deal.II/dofs/dof_handler.h>

#include <perideal/mesh/cell_search.h>
#include <perideal/operators/bounds/local_bound.h>
#include <perideal/operators/interface/row_set.h>
#include <perideal/operators/parts/crack_side_factors.h>
#include <perideal/operators/parts/hanging_nodes.h>

#include <vector>

namespace PeriDeal
{
  /**
   * Memory of the changes of a matrix of finite elements, so that an event costs what changes and
   * not what there is.
   */
  template <int dim>
  struct EventWork
  {
    using Cell  = typename dealii::DoFHandler<dim>::active_cell_iterator;
    using Boxes = std::vector<dealii::BoundingBox<dim>>;

    /** @param held_rows of owned unknowns that are not free */
    EventWork(const dealii::DoFHandler<dim>   &dofs,
              const Vector                    &layout,
              const std::vector<unsigned int> &held_rows);

    /**
     * Cells of this process and ghosts that come within a distance of the cuts, or another one of
     * the joins; each once. Not collective.
     */
    std::vector<Cell> cells_near(const Boxes &cuts,
                                 const double of_cuts,
                                 const Boxes &joins,
                                 const double of_joins) const;

    /** The rows of a cell's unknowns change, and of the masters of hanging ones. Not collective. */
    void touch(const std::vector<dealii::types::global_dof_index> &of_cell,
               const HangingNodes<dim>                            &hanging);

    CellSearch<dim>        search;
    RowSet                 touched, held; // rows that the event changes; that are not free
    CrackSideFactors::Sums factors;
    LocalBound             bound;

  private:
    const std::shared_ptr<const dealii::Utilities::MPI::Partitioner> layout;
  };


  /** Local numbers of the owned unknowns of some cells, ascending. Not collective. */
  template <int dim>
  std::vector<unsigned int> owned_unknowns(
    const std::vector<typename dealii::DoFHandler<dim>::active_cell_iterator> &cells,
    const dealii::Utilities::MPI::Partitioner                                 &layout);


  /**
   * One box for all that joins the zone beside each cut, the same on all processes: a cell may feel
   * what happens a little farther away than its own process knows of. Collective.
   */
  template <int dim>
  std::vector<dealii::BoundingBox<dim>> boxes_beside(
    const std::vector<dealii::BoundingBox<dim>> &cuts,
    const std::vector<dealii::BoundingBox<dim>> &joins,
    const MPI_Comm                               communicator);
} // namespace PeriDeal
