// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/bounding_box.h>
#include <deal.II/base/types.h>

#include <array>
#include <vector>

namespace PeriDeal
{
  /** Two nodes by their global numbers, the smaller one first. */
  using NodePair = std::array<dealii::types::global_dof_index, 2>;


  /**
   * What has changed of a body from one time to another: made by the history of its cracks
   * (CrackHistory::change()) or by damage (BondBreaking::break_bonds(), and DamageOfSolid for the
   * heat of the same nodes), consumed by operators and their bonds, cells and couplings, which mend
   * only what it names. The same on all processes, but for the nodes.
   */
  template <int dim>
  struct ChangeSet
  {
    double                                from = 0., to = 0.; // representative times of the cracks
    double                                since = 0.; // when those of `to` begin: an event, or 0
    std::vector<dealii::BoundingBox<dim>> cuts;       // around what is cut, or conducts otherwise

    bool damage = false; // bonds have broken, else cracks have changed

    /** Of damage: the owned nodes that have lost a bond, in ascending order. */
    std::vector<unsigned int> nodes;

    /** Of damage that another physics follows: the bonds that have broken, ascending. */
    std::vector<NodePair> broken;
  };
} // namespace PeriDeal
