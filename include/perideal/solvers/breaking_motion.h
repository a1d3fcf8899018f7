// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/solid/elastic_operator.h>

#include <vector>

namespace PeriDeal
{
  /**
   * The motion of a body of density one under loads and supports at rest, in which bonds break as
   * they do in any motion: at the step at which they are stretched too far. A crack between two
   * equilibria finds its way so, hardly drawn to the rows of the lattice. (Equilibria after each
   * break hold it back at each bond, most of all where it would leave a row.) The damping,
   * proportional to the mass, halves waves on their way through 70 horizons; what still moves when
   * the last bond has broken is left to the next equilibrium.
   *
   * Steps are those of velocity Verlet, of second order also where bonds break: each half of a step
   * takes the forces of the bonds there are in it. One more application where bonds have broken.
   */
  class BreakingMotion
  {
  public:
    /** @param op is referred to. @param share of the stable step; 0 to 1. */
    explicit BreakingMotion(ElasticOperator &op, const double share = 0.9);

    /**
     * From u at rest, distributed, until no bond has broken for a while. Returns the number of
     * steps. Collective.
     */
    unsigned int run(Vector &u, const double t);

    /**
     * What the last run took from the body but what bonds released: by damping, and what still
     * moved at its end. Strain energy and work of loads balance it to O(step^2). Collective.
     */
    double lost() const;

    /** The spectrum of K may have grown. Not collective. */
    void operator_changed()
    {
      step = 0.;
    }

    /** What the next run depends on. Collective. */
    void exchange(Archive &archive)
    {
      archive.exchange("step of breaking", step);
    }

  private:
    void   choose_step();
    double kinetic_energy() const; // on this process

    ElasticOperator          &op;
    const double              share;
    const std::vector<double> inverse_mass;
    double                    step   = 0.; // 0: to be chosen
    double                    damped = 0.; // energy, in the last run, on this process
    Vector                    velocity, residual;
  };
} // namespace PeriDeal
