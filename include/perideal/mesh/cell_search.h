// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/bounding_box.h>
#include <deal.II/dofs/dof_handler.h>

#include <memory>
#include <vector>

namespace PeriDeal
{
  /**
   * Finds cells by place, in a time that grows with their number found. Knows this process's cells
   * and ghost cells as they are when it is made.
   */
  template <int dim>
  class CellSearch
  {
  public:
    using Cell = typename dealii::DoFHandler<dim>::active_cell_iterator;

    explicit CellSearch(const dealii::DoFHandler<dim> &dofs);
    ~CellSearch();

    /**
     * Add the cells that come within a distance of some box, in the coordinate directions, to a
     * list, which is ascending then and has each once.
     */
    void find(const std::vector<dealii::BoundingBox<dim>> &boxes,
              const double                                 distance,
              std::vector<Cell>                           &cells) const;

    /** The longest diagonal of a cell known here. */
    double largest_diameter() const
    {
      return diameter;
    }

  private:
    struct Tree;
    std::unique_ptr<Tree> tree;
    double                diameter = 0.;
  };
} // namespace PeriDeal
