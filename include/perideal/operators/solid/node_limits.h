// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/solid/damage_criterion.h>

#include <cmath>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /**
   * What multiplies critical stretches (Weibull modulus), or 1, of owned nodes and ghosts.
   * Collective.
   */
  template <int dim>
  std::vector<double> scatter_factors(const BreakableBonds<dim> &bonds);


  /**
   * Limits of nodes by a formula of x, y, z, t and T (limit_of_bonds()): factor times its value,
   * or times the root of that. Of owned nodes and ghosts.
   */
  template <int dim>
  class NodeLimits
  {
  public:
    /**
     * Values are those at t = 0.
     * @param factors of owned nodes and ghosts @param of_root the root of the value counts
     * Throws UserError for those that are not above 0. Collective.
     */
    NodeLimits(const BreakableBonds<dim> &bonds, std::vector<double> factors, const bool of_root);

    /** As DamageCriterion::take_time(). What has no value above 0 is a fault of the formula. */
    bool take_time(const double t, const std::vector<double> &temperatures);

    const std::vector<double> &values() const
    {
      return now;
    }

    std::size_t memory_consumption() const
    {
      return (factors.capacity() + now.capacity()) * sizeof(double) +
             known_temperatures.capacity() * sizeof(double);
    }

  private:
    double limit(const unsigned int i, const double t, const std::vector<double> &temperatures);
    std::string fault_at(const dealii::Point<dim> &p, const double t) const;

    const Nodes<dim>         &nodes;
    const MaterialProperty   &formula;
    const std::string         entry;
    const std::vector<double> factors;
    const bool                of_root;
    std::vector<double>       now, known_temperatures; // of the latest take_time()
    double                    known_time = 0.;
  };
} // namespace PeriDeal
