// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/solid/bond_strengths.h>

#include <algorithm>
#include <vector>

namespace PeriDeal
{
  /**
   * Critical stretches, where cracks of the scene go on straight across the mean tension about
   * their tips (CrackPaths): a bond beside their ways does not break, however far it is stretched.
   */
  template <int dim>
  class MeanTensionCriterion : public DamageCriterion<dim>
  {
  public:
    /** As BondStrengths. Collective. */
    MeanTensionCriterion(const BreakableBonds<dim>                          &bonds,
                         const std::vector<std::vector<dealii::Point<dim>>> &cracks)
      : strengths(bonds)
      , nodes(bonds.families.nodes())
      , ways(cracks, bonds.families.weights().horizon())
    {}

    BondMeasure measure(const unsigned int i,
                        const unsigned int j,
                        const double       extension,
                        const double       length) const override
    {
      // Below this nobody asks what may break.
      constexpr double share = 0.9;
      BondMeasure      found = strengths.measure(i, j, extension, length);
      if (found.exceeds(share) && !ways.may_break({nodes.position(i), nodes.position(j)}))
        found.value = share * found.limit;
      return found;
    }

    const std::vector<double> &least_stretches() const override
    {
      return strengths.least_stretches();
    }

    bool take_time(const double t, const std::vector<double> &temperatures) override
    {
      return strengths.take_time(t, temperatures);
    }

    const std::vector<double> &of_nodes() const override
    {
      return strengths.of_nodes();
    }

    std::size_t memory_consumption() const override
    {
      return strengths.memory_consumption() + ways.memory_consumption();
    }

    CrackPaths<dim> *paths() const override
    {
      return &ways;
    }

  private:
    BondStrengths<dim>      strengths;
    const Nodes<dim>       &nodes;
    mutable CrackPaths<dim> ways; // led on by those who break bonds
  };
} // namespace PeriDeal
