// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/solid/elastic_operator.h>

namespace PeriDeal
{
  /**
   * Loads that go back where a body would give way at once (`Breaking = controlled`), as those of a
   * test that is controlled by the opening of the crack: at each equilibrium all loads and
   * prescribed displacements of the time are multiplied by the largest factor, at most 1, at which
   * no bond is stretched much farther than it has been; then the most stretched ones bear less, as
   * if they were stretched a little farther. That follows a path of equilibria through snap-back,
   * event by event (sequentially linear analysis: Rots 2001, there with jagged laws). A load step
   * ends when the whole loads are borne, or a share of the largest strain energy so far has been
   * dissipated on a way back, where loads do negative work.
   *
   * For bodies whose forces are linear as long as bonds do not change: then the equilibrium under
   * f times the loads is f times that under the loads.
   */
  class LoadControl
  {
  public:
    /** @param op is referred to. @param share of the largest strain energy, by which steps end */
    LoadControl(ElasticOperator &op, const double share);

    /** A load step begins. */
    void begin_step()
    {
      last.going_back = 0.;
      before          = op.stepping.load_factor;
    }

    /** It is given up: the equilibrium is the one before it. */
    void leave_step()
    {
      op.stepping.load_factor = before;
    }

    /** The whole loads were borne before the step, and are not any more. */
    bool turns_back() const
    {
      return before == 1. && op.stepping.load_factor < 1.;
    }

    /** From an equilibrium to the one under the whole loads, with the bonds as they are. */
    void take_forward(Vector &u);

    /** From the equilibrium under the whole loads to the one under those that bonds bear. */
    void take_back(Vector &u, const double t);

    /**
     * Let bonds that are pressed again be whole, or, if there are none, the most stretched ones
     * bear less. Returns whether any bonds have changed; not: the step is at its end. Collective.
     *
     * @param energy     strain energy of the equilibrium u
     * @param dissipated by the body so far
     */
    bool break_bonds(Vector &u, const double t, const double energy, const double dissipated);

    /** The smallest so far. */
    double least_factor() const
    {
      return least;
    }

    /** What the next step depends on. Collective. */
    void exchange(Archive &archive);

  private:
    ElasticOperator &op;
    const double     share;
    double           before = 1., largest = 0., least = 1.;
    struct
    {
      double energy = 0., dissipated = 0.;
      double going_back = 0.; // dissipated in the step while loads did negative work
    } last;
    Vector scaled;
  };
} // namespace PeriDeal
