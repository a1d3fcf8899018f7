// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/archive.h>
#include <perideal/base/types.h>

namespace PeriDeal
{
  /**
   * Forces that nodes make of their families as a whole, in place of those that bonds make one by
   * one (SolidSums, BondForces).
   *
   * Trials leave nothing behind until accept(). Ghosts of displacements need not be up to date.
   */
  template <int dim>
  class FamilyForces
  {
  public:
    virtual ~FamilyForces() = default;

    /** Forces are linear in u, and K is always the same in a step. Not collective. */
    virtual bool is_linear() const = 0;

    /** Forces are others than K u: those of find_forces(), by what was accepted. Not collective. */
    virtual bool remembers() const
    {
      return !is_linear();
    }

    /** K is that of multiply(); else that of the linear bonds. Not collective. */
    virtual bool has_tangent() const
    {
      return true;
    }

    /** y = K x. Collective. */
    virtual void multiply(Vector &y, const Vector &x) const = 0;

    /** y = -F at u and time t, by thermal strains, too. Collective. */
    virtual void find_forces(Vector &y, const Vector &u, const double t) const = 0;

    /**
     * Temperatures have become those of nodes, ghosts up to date, or if this is empty those of the
     * scene's formula: strains by them, and what of the law depends on them. Throws UserError: a
     * yield stress that is none. Collective.
     */
    virtual void take_temperatures(const Vector &changes) = 0;

    /** What is stored. Collective. */
    virtual double energy(const Vector &u) const = 0;

    /** Go on from u at time t. Returns what the step has dissipated (StepWork). Collective. */
    virtual double accept(const Vector &u, const double t) = 0;

    /** Collective. */
    virtual void exchange(Archive &archive, const NodeKeys &keys) = 0;

    /** Make K the tangent at u. Collective. */
    virtual void linearize(const Vector &u) = 0;

    /** K is that of the elastic body until linearize(): no body that yields is stiffer. */
    virtual void forget_tangent() = 0;

    virtual std::size_t memory_consumption() const = 0;
  };
} // namespace PeriDeal
