// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/solid/node_limits.h>

#include <vector>

namespace PeriDeal
{
  /**
   * A bond breaks where it is stretched and the mean of the largest principal stresses, or of von
   * Mises' stresses, of both ends exceeds the critical stress (the smaller one of its ends); by the
   * principal stress only where it lies near enough to the tension: where the stress along it,
   * n . sigma n of the mean of both ends, is at least half of that mean. In uniaxial tension these
   * are bonds at less than 45 degrees from it, in equal tension in all directions all. In two
   * dimensions principal stresses are those in the plane.
   */
  template <int dim>
  class StressCriterion : public DamageCriterion<dim>
  {
  public:
    /** Throws UserError for stresses that are not above 0. Collective. */
    explicit StressCriterion(const BreakableBonds<dim> &bonds);

    BondMeasure measure(const unsigned int i,
                        const unsigned int j,
                        const double       extension,
                        const double       length) const override;

    bool take_time(const double t, const std::vector<double> &temperatures) override
    {
      return limits.take_time(t, temperatures);
    }

    NodeQuantity asks_for() const override
    {
      return NodeQuantity::stresses;
    }

    void take_state(const std::vector<Vector> &values) override;

    /** 0 where a bond of a node may break, of those that are stretched; else infinity. */
    const std::vector<double> &least_stretches() const override
    {
      return least;
    }

    const std::vector<double> &of_nodes() const override
    {
      return limits.values();
    }

    std::string name_of_limit() const override
    {
      return "critical stress";
    }

    std::size_t memory_consumption() const override
    {
      return limits.memory_consumption() +
             (least.capacity() + stresses.capacity()) * sizeof(double) +
             along.capacity() * sizeof(along[0]);
    }

  private:
    const Nodes<dim>                            &nodes;
    const bool                                   is_principal;
    NodeLimits<dim>                              limits;
    std::vector<double>                          stresses, least;
    std::vector<dealii::SymmetricTensor<2, dim>> along; // in the plane; principal stresses
  };
} // namespace PeriDeal
