// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/mesh/cell_search.h>
#include <perideal/scene/crack_geometry.h>

#include <vector>

namespace PeriDeal
{
  /** What a node counts in the value at a point, and in the gradient there. */
  template <int dim>
  struct Share
  {
    dealii::types::global_dof_index dof;
    double                          weight;
    dealii::Tensor<1, dim>          slope;
  };


  /** So many nodes, at most, make a value on one side of a crack. */
  template <int dim>
  constexpr unsigned int most_shares = 3 * (dim + 1);

  /** Whether a crack lies between two points. */
  template <int dim>
  bool parted(const std::vector<CrackGeometry<dim>> &cracks,
              const dealii::Point<dim>              &a,
              const dealii::Point<dim>              &b);

  /**
   * What is read at a point beside a crack: the linear function that fits the nearest nodes of the
   * cells around, those that no crack parts from the point, each by about the inverse square of its
   * distance. The nearest one alone where they do not make a linear function; nothing where there
   * is none. Not collective.
   *
   * @param cell that holds the point
   */
  template <int dim>
  std::vector<Share<dim>> fit_own_side(const CellSearch<dim>                 &search,
                                       const typename CellSearch<dim>::Cell  &cell,
                                       const dealii::Point<dim>              &point,
                                       const std::vector<CrackGeometry<dim>> &cracks);
} // namespace PeriDeal
