// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/change_set.h>

#include <vector>

namespace PeriDeal
{
  /**
   * Bonds that another physics of the same model has broken, and what they let through: the view
   * that diffusion has of the BondState of a solid. Pairs of nodes by their global numbers, all
   * of the body on every process. Not collective.
   */
  class BrokenBonds
  {
  public:
    /** @param transmission of broken bonds, between 0 and 1 */
    explicit BrokenBonds(const double transmission);

    /** More of them, ascending. */
    void add(const std::vector<NodePair> &more);

    /** There may be some, which conduct less. */
    bool are_followed() const
    {
      return transmission < 1.;
    }

    bool empty() const
    {
      return pairs.empty();
    }

    /** Some bond of this node has broken. */
    bool touch(const dealii::types::global_dof_index node) const;

    /** What is left between two nodes: 1, or the transmission. */
    double kept_fraction(const dealii::types::global_dof_index a,
                         const dealii::types::global_dof_index b) const;

  private:
    const double                                 transmission;
    std::vector<NodePair>                        pairs; // ascending, as the nodes
    std::vector<dealii::types::global_dof_index> nodes;
  };
} // namespace PeriDeal
