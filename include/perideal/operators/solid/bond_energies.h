// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/solid/node_limits.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace PeriDeal
{
  /**
   * A bond breaks where it is stretched and has stored more than w_c f V_i V_j (Foster, Silling,
   * Chen 2011), f the part of the other volume within the horizon and w_c the fracture energy G
   * over the sum of f V_j xi_n over half a family, mean over the axes n: in a ball of three
   * dimensions 4 G/(pi delta^4). With the symbols of LinearPeridynamicSolid and s = e/x the bond
   * has stored
   *
   *   W x^2 s (b_i/q_i s + b_j/q_j s + tau_i + tau_j)/2,
   *
   * half of its force times its extension; all bonds together have stored the strain energy. In the
   * bond-based solid (tau = 0) that is a critical stretch of each length. Where W x^2 is not the
   * same for all lengths, bonds do not break at one stretch (Seleson, Stinga, Vaughan 2026).
   *
   * Measures are roots, which go with the load. Of both ends the smaller w_c counts.
   */
  template <int dim>
  class BondEnergies : public DamageCriterion<dim>
  {
  public:
    /** Throws UserError for energies that are not above 0. Collective. */
    BondEnergies(const BreakableBonds<dim> &bonds, const VolumeFraction fraction);

    BondMeasure measure(const unsigned int i,
                        const unsigned int j,
                        const double       extension,
                        const double       length) const override
    {
      const double s      = extension / length;
      const double force  = s * (stiffness(i) + stiffness(j)) + tension(i) + tension(j);
      const double stored = s > 0. ? square_over_volumes(i, j) * s * force : 0.;
      return {std::sqrt(std::max(0., stored)),
              std::sqrt(2. * std::min(limits.values()[i], limits.values()[j]))};
    }

    bool take_time(const double t, const std::vector<double> &temperatures) override
    {
      return limits.take_time(t, temperatures);
    }

    NodeQuantity asks_for() const override
    {
      return NodeQuantity::tensions;
    }

    void take_state(const std::vector<Vector> &values) override
    {
      state = values;
      for (const Vector &of : state) // which copies of vectors are without
        of.update_ghost_values();
    }

    /** Bonds that are pressed do not break. */
    const std::vector<double> &least_stretches() const override
    {
      return least;
    }

    /** w_c */
    const std::vector<double> &of_nodes() const override
    {
      return limits.values();
    }

    std::string name_of_limit() const override
    {
      return "critical energy of bonds";
    }

    /** f of a bond with this vector. */
    double part(const dealii::Tensor<1, dim> &xi) const;

    std::size_t memory_consumption() const override
    {
      return limits.memory_consumption() + least.capacity() * sizeof(double) +
             2 * limits.values().capacity() * sizeof(double) + squares.capacity() * sizeof(double);
    }

  private:
    double tension(const unsigned int i) const
    {
      return state.empty() ? 0. : state[0].local_element(i);
    }

    double stiffness(const unsigned int i) const
    {
      return state.empty() ? 0. : state[1].local_element(i);
    }

    /** W x^2/(f V_i V_j), the same digits from both ends. */
    double square_over_volumes(const unsigned int i, const unsigned int j) const;

    std::vector<double> factors_of(const BreakableBonds<dim> &bonds) const;

    const Families<dim>      &families;
    const VolumeFraction      fraction;
    NodeLimits<dim>           limits; // w_c
    const std::vector<double> least;
    std::vector<Vector>       state;   // tau, b/q
    std::vector<double>       squares; // W x^2/(f V_i V_j) of the members of a lattice's family
  };
} // namespace PeriDeal
