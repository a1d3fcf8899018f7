// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/bonds/families.h>
#include <perideal/scene/material.h>

#include <algorithm>
#include <vector>

namespace PeriDeal
{
  /**
   * Critical stretches of bonds: the smaller one of both ends, or, where the material on the
   * straight way between them is weaker than at both, that of a bond whose ends have the fracture
   * energy (critical stretch) of the weakest place: the smaller s_i sqrt(G_min/G_i) of both ends.
   * So a layer between two rows of nodes takes its own energy to break, however thin it is.
   *
   * Ways are looked at where the material is seen to be weaker between a node of the family and the
   * next ones, in 32 places each.
   */
  template <int dim>
  class BondStrengths
  {
  public:
    /**
     * @param of_nodes critical stretches of owned nodes and ghosts
     * Throws UserError for those on the way that are not above 0. Collective.
     */
    void set(const Families<dim> &families, const Material &material, std::vector<double> of_nodes);

    /** An owned node and a neighbour, or the origin of its image, in either order. */
    double of_bond(const unsigned int i, const unsigned int j) const
    {
      const double at_ends = std::min(nodes[i], nodes[j]);
      if (begins.empty())
        return at_ends;
      const bool         owned = i + 1 < begins.size();
      const unsigned int node = owned ? i : j, other = owned ? j : i;
      if (node + 1 < begins.size())
        for (std::size_t k = begins[node]; k < begins[node + 1]; ++k)
          if (weak[k].neighbor == other)
            return weak[k].stretch;
      return at_ends;
    }

    /** Of owned nodes and ghosts, bonds apart; empty before set(). */
    const std::vector<double> &of_nodes() const
    {
      return nodes;
    }

    /** The least of a node's bonds to weaker or equal ones and of itself. */
    const std::vector<double> &least_at_nodes() const
    {
      return begins.empty() ? nodes : least;
    }

    std::size_t memory_consumption() const
    {
      return (nodes.capacity() + least.capacity()) * sizeof(double) +
             begins.capacity() * sizeof(std::size_t) + weak.capacity() * sizeof(Weak);
    }

  private:
    struct Weak
    {
      unsigned int neighbor;
      double       stretch;
    };

    /** Beside these local nodes the material is weaker than at them. */
    std::vector<bool> beside_weaker(const Families<dim>    &families,
                                    const MaterialProperty &strength) const;

    std::vector<double>      nodes, least;
    std::vector<std::size_t> begins; // by owned node; empty: no way is weaker than its ends
    std::vector<Weak>        weak;
  };
} // namespace PeriDeal
