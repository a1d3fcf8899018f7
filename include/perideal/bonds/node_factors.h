// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/neighbors.h>

#include <vector>

namespace PeriDeal
{
  /** Surface correction (doc/theory.md): factors of nodes, from which those of bonds follow. */
  template <int dim>
  class NodeFactors
  {
  public:
    /** None. Neighbours have to outlive this object. */
    explicit NodeFactors(const Neighbors<dim> &neighbors);

    /**
     * The factors of nodes, owned and ghosts, one for each direction in turn or a single one for
     * all. A bond's is the mean of its nodes', those of the directions weighted with the squares of
     * the bond's direction cosines. A fictitious node has the factor of its mirror, or 1. An empty
     * list takes the factors away.
     */
    void set(std::vector<double> factors, const unsigned int n_directions, const bool mirrored);

    bool empty() const
    {
      return factors.empty();
    }
    double of_bond(const unsigned int node, const unsigned int neighbor) const;

    std::size_t memory_consumption() const;

  private:
    double of_node(const unsigned int node, const unsigned int direction) const;

    const Neighbors<dim> &neighbors;
    std::vector<double>   factors;
    unsigned int          n_directions = 1; // 1: all alike
    bool                  mirrored     = true;
  };
} // namespace PeriDeal
