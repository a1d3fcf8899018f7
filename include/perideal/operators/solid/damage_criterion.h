// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/types.h>
#include <perideal/bonds/families.h>
#include <perideal/operators/solid/crack_paths.h>
#include <perideal/scene/material.h>

#include <functional>
#include <string>
#include <vector>

namespace PeriDeal
{
  /** What a bond is measured by, and where it breaks, in the same unit. */
  struct BondMeasure
  {
    double value, limit;

    bool exceeds(const double share_of_limit = 1.) const
    {
      return value > share_of_limit * limit;
    }

    double over_limit() const
    {
      return value / limit;
    }
  };


  /**
   * What a plane at a node cuts, all of it stretched by s while all else is at rest: energies per
   * area over s^2, the stress across the plane over s.
   */
  struct CrossingEnergy
  {
    double total() const
    {
      return extensions + dilatations;
    }

    double extensions = 0., dilatations = 0.;
    double over_lengths = 0.; // of the extensions, that of each bond over its length
    double stress = 0., stress_of_dilatations = 0.;
  };


  /** The bonds that a criterion is for; all of it outlives the criterion. */
  template <int dim>
  struct BreakableBonds
  {
    const Families<dim>                        &families;
    const Material                             &material;
    std::function<CrossingEnergy(unsigned int)> crossing_energy; // of an owned node
    std::vector<double> temperatures; // as DamageCriterion::take_time() takes them
  };


  /** What a criterion has to know of the body that is deformed, beside the extensions of bonds. */
  enum class NodeQuantity
  {
    none,
    tensions, // tau = c theta/q and b/q (LinearPeridynamicSolid)
    stresses  // the six components in the order of SymmetricTensor<2, 3>
  };


  /**
   * When a bond of a solid breaks for good, or begins to soften: its measure is above its limit.
   * The same for peridynamics alone (BondBreaking) and for zones beside elements (ZoneBreaking).
   * Not collective.
   */
  template <int dim>
  class DamageCriterion
  {
  public:
    virtual ~DamageCriterion() = default;

    /**
     * Of the bond between an owned node i and j, a node known here or the origin of its image; to
     * the last bit the same from both ends.
     *
     * @param extension e, without thermal strain, times any positive number
     * @param length x, times that number
     */
    virtual BondMeasure measure(const unsigned int i,
                                const unsigned int j,
                                const double       extension,
                                const double       length) const = 0;

    /**
     * Of owned nodes and ghosts: no bond is above its limit while e/x is not above the smaller
     * value of both ends, so that StretchScreen can leave nodes out and a zone knows where to grow.
     * Minus infinity: not known, all bonds are looked at, and no zone follows.
     */
    virtual const std::vector<double> &least_stretches() const = 0;

    /**
     * Limits are those at time t.
     *
     * @param temperatures of owned nodes and ghosts; empty: nobody asks for them
     * @return whether some have changed, with least_stretches()
     */
    virtual bool take_time(const double /*t*/, const std::vector<double> & /*temperatures*/)
    {
      return false;
    }

    /** What take_state() gets. */
    virtual NodeQuantity asks_for() const
    {
      return NodeQuantity::none;
    }

    /** Bonds are measured in that state: values of nodes with up-to-date ghosts, one by one. */
    virtual void take_state(const std::vector<Vector> & /*values*/) {}

    /** Bonds go on beyond their limit, and integrity() is to be asked. */
    virtual bool softens() const
    {
      return false;
    }

    /**
     * What a bond bears, by what it would without damage, that has been at @p ratio times its limit
     * at most, above 1; to the last bit the same from both ends. 0: it is broken.
     */
    virtual double integrity(const unsigned int /*i*/,
                             const unsigned int /*j*/,
                             const double /*length*/,
                             const double /*ratio*/) const
    {
      return 0.;
    }

    /**
     * The largest part of the fracture energy that bonds have stored when they begin to soften;
     * from 1 on some break at once. In proportion to the horizon.
     */
    virtual double stored_at_onset() const
    {
      return 0.;
    }

    /** Limits of owned nodes and ghosts, as they are reported, and their name. */
    virtual const std::vector<double> &of_nodes() const = 0;

    virtual std::string name_of_limit() const
    {
      return "critical stretch";
    }

    virtual std::size_t memory_consumption() const = 0;

    /**
     * Ways of cracks, beside which no bond is above its limit: to be turned by what whole bonds
     * bear where some are, and led on by those that break. Null: bonds break one by one.
     */
    virtual CrackPaths<dim> *paths() const
    {
      return nullptr;
    }
  };
} // namespace PeriDeal
