// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/solid/damage_criterion.h>

#include <algorithm>
#include <vector>

namespace PeriDeal
{
  /** Which bonds lead from one phase to another that it has an interface with. Not collective. */
  template <int dim>
  class InterfaceBonds
  {
  public:
    explicit InterfaceBonds(const BreakableBonds<dim> &bonds)
      : n_phases(bonds.material.phases.all().names.size() + 1)
    {
      const Nodes<dim> &places = bonds.families.nodes();
      if (bonds.material.law.interfaces.empty())
        return;
      for (unsigned int i = 0; i < places.n_local(); ++i)
        phases.push_back(bonds.material.phases.all().at(places.position(i)) + 1);
      numbers.assign(n_phases * n_phases, none);
      for (unsigned int k = 0; k < bonds.material.law.interfaces.size(); ++k)
        {
          const auto &[a, b]                  = bonds.material.law.interfaces[k].phases;
          numbers[(a + 1) * n_phases + b + 1] = numbers[(b + 1) * n_phases + a + 1] = k;
        }
    }

    /** The same on all processes, also on one without nodes. */
    bool any() const
    {
      return !numbers.empty();
    }

    static constexpr int none = -1;

    /** The number of the interface between two nodes of this process or ghosts, or none. */
    int between(const unsigned int i, const unsigned int j) const
    {
      return any() ? numbers[phases[i] * n_phases + phases[j]] : none;
    }

    /**
     * The least value of each owned node and of its bonds across interfaces.
     * @param of_bond by both nodes and the number of the interface
     */
    template <typename Value>
    void lower(const Families<dim> &families,
               const Value         &of_bond,
               std::vector<double> &values) const
    {
      std::vector<typename Families<dim>::Member> family;
      for (unsigned int i = 0; any() && i < families.nodes().n_owned(); ++i)
        {
          families.members_of(i, family);
          for (const auto &bond : family)
            if (const int k = between(i, bond.neighbor); k != none)
              values[i] = std::min(values[i], of_bond(i, bond.neighbor, k));
        }
    }

    std::size_t memory_consumption() const
    {
      return phases.capacity() * sizeof(unsigned int);
    }

  private:
    unsigned int              n_phases; // the rest is the first one
    std::vector<unsigned int> phases;   // of nodes
    std::vector<int>          numbers;  // of interfaces, by two phases
  };
} // namespace PeriDeal
