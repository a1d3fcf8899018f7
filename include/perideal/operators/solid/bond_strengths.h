// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/solid/interface_bonds.h>
#include <perideal/operators/solid/node_limits.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace PeriDeal
{
  /**
   * Critical stretches of bonds: given, or those at which what crosses a plane has stored the
   * fracture energy, times what scatters (WeibullField). Of a bond the smaller one of both ends,
   * or, where the material on the straight way between them is weaker than at both, that of a bond
   * whose ends have the fracture energy (critical stretch) of the weakest place: the smaller
   * s_i sqrt(G_min/G_i) of both ends.
   * So a layer between two rows of nodes takes its own energy to break, however thin it is.
   *
   * Bonds across an interface of two phases (Material::Law::Interface) break at the stretch at
   * which what crosses it, half of it that of each side, has stored its energy:
   * sqrt(2 G/(c_i + c_j)), c = G_i/s_i^2.
   *
   * Ways are looked at where the material is seen to be weaker between a node of the family and the
   * next ones, in 32 places each. Limits that change in time or with the temperature are those of
   * the ends of bonds alone.
   */
  template <int dim>
  class BondStrengths : public DamageCriterion<dim>
  {
  public:
    /** Throws UserError for those at nodes and on the way that are not above 0. Collective. */
    explicit BondStrengths(const BreakableBonds<dim> &bonds);

    BondMeasure measure(const unsigned int i,
                        const unsigned int j,
                        const double       extension,
                        const double       length) const override
    {
      return {extension, length * of_bond(i, j)};
    }

    /** An owned node and a neighbour, or the origin of its image, in either order. */
    double of_bond(const unsigned int i, const unsigned int j) const
    {
      if (const int k = interfaces.between(i, j); k != InterfaceBonds<dim>::none)
        return across(i, j, k);
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

    bool take_time(const double t, const std::vector<double> &temperatures) override
    {
      if (!changing || !changing->take_time(t, temperatures))
        return false;
      nodes = changing->values();
      if (!least.empty())
        std::transform(nodes.begin(), nodes.end(), least_across.begin(), least.begin(), least_of);
      return true;
    }

    const std::vector<double> &of_nodes() const override
    {
      return nodes;
    }

    /** The least of a node's bonds to weaker or equal ones and of itself. */
    const std::vector<double> &least_stretches() const override
    {
      return least.empty() ? nodes : least;
    }

    std::size_t memory_consumption() const override
    {
      return (nodes.capacity() + least.capacity() + crossing.capacity()) * sizeof(double) +
             least_across.capacity() * sizeof(double) +
             (changing ? changing->memory_consumption() : 0) + interfaces.memory_consumption() +
             begins.capacity() * sizeof(std::size_t) + weak.capacity() * sizeof(Weak);
    }

  private:
    struct Weak
    {
      unsigned int neighbor;
      double       stretch;
    };

    static double least_of(const double a, const double b)
    {
      return std::min(a, b);
    }

    /** Of the bond between two nodes across the interface k. */
    double across(const unsigned int i, const unsigned int j, const unsigned int k) const
    {
      return std::sqrt(2. * energies[k] / (crossing[i] + crossing[j]));
    }

    void find_weak(const Families<dim>    &families,
                   const MaterialProperty &strength,
                   std::vector<double>    &lowest);

    /** Beside these local nodes the material is weaker than at them. */
    std::vector<bool> beside_weaker(const Families<dim>    &families,
                                    const MaterialProperty &strength) const;

    const bool                     of_energy;    // from the fracture energy; else given
    std::vector<double>            nodes, least; // empty: as nodes
    const InterfaceBonds<dim>      interfaces;
    std::vector<double>            energies; // of interfaces
    std::vector<double>            crossing; // c of nodes, with interfaces only
    std::vector<std::size_t>       begins;   // by owned node; empty: no way is weaker than its ends
    std::vector<Weak>              weak;
    std::optional<NodeLimits<dim>> changing;     // or none: limits stay
    std::vector<double>            least_across; // of bonds across interfaces, with least
  };
} // namespace PeriDeal
