// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/archive.h>
#include <perideal/base/types.h>
#include <perideal/operators/solid/bond_ends.h>
#include <perideal/scene/expression.h>

namespace PeriDeal
{
  /**
   * How fast bonds are stretched in motion, and by how much that raises their limits: with the
   * stretch s = e/x of a bond now and at the last look before (those of explicit steps),
   *
   *     limit <- f(rate) limit,  rate = max(0, (s - s_before)/(t - t_before)),
   *
   * and 0 at the first look; of a formula f >= 1 with f(0) = 1 (`Rate factor`), so that the limit
   * without it is a bound from below of all limits.
   */
  template <int dim>
  class StretchRates
  {
  public:
    /**
     * All have to outlive this object.
     * @param nodes of the bonds @param is_full strains are those of the deformed bonds
     */
    StretchRates(const Nodes<dim>    &nodes,
                 const BondEnds<dim> &ends,
                 const Expression    &factor,
                 const bool           is_full);

    /** Bonds are looked at in the state u, at time t. Collective. */
    void take(const Vector &u, const double t);

    /**
     * f of the bond between an owned node i and j, a node known here or a fictitious one; to the
     * last bit the same from both ends. What is less than 1 is a fault of the formula. Not
     * collective.
     */
    double factor(const unsigned int i, const unsigned int j) const;

    /** Collective. */
    void exchange(Archive &archive, const NodeKeys &keys);

    std::size_t memory_consumption() const
    {
      return 2 * (now.displacement.memory_consumption() + now.images.capacity() * sizeof(double));
    }

  private:
    /** What bonds are looked at in. */
    struct State
    {
      Vector              displacement; // ghosts up to date
      std::vector<double> images;       // of fictitious nodes
      double              time = 0.;
    };

    double stretch(const State &state, const unsigned int i, const unsigned int j) const;
    void   find_images(State &state) const;

    const BondEnds<dim> &ends;
    const Expression    &of_rate;
    const bool           is_full;
    State                now, before;
    bool                 begun = false;
  };
} // namespace PeriDeal
