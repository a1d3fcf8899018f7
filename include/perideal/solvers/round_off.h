// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/solvers/static_solver.h>

#include <limits>

namespace PeriDeal
{
  /**
   * The largest l2 norm that round-off may leave of forces on free unknowns at u: machine epsilon
   * times the forces that balance each other at a node, for which the diagonal of K times the
   * displacement stands, and a factor of 16 for their number. No more than 1e-4 of what the
   * tolerance refers to: a part that nothing holds goes so far that round-off would allow anything.
   * Collective.
   */
  double round_off_of_forces(const ElasticOperator &op, const Vector &u, const double size);

  /**
   * A residual above the tolerance has been accepted, as round-off allows no less: its norm over
   * that which the tolerance refers to. Not collective.
   */
  void accept_residual(const double relative);

  /** The largest one that was accepted since this was asked last; 0: none. Not collective. */
  double take_accepted_residual();


  /**
   * When to stop above the tolerance: where residuals have not fallen by half within the last fifth
   * of the iterations, 100 at least, and are those of round_off_of_forces().
   */
  class RoundOffGoal
  {
  public:
    /** @param size as of ResidualGoal */
    RoundOffGoal(const ElasticOperator &op, const StaticOptions &options, const double size);

    /**
     * To be asked in each iteration n, before ResidualGoal, of the residual r at u. What is
     * accepted is told by accept_residual(). Collective.
     */
    bool reached(const Vector &r, const Vector &u, const unsigned int n);

  private:
    const ElasticOperator &op;
    const StaticOptions    options;
    double                 size, lowest = std::numeric_limits<double>::max(), before = lowest;
    unsigned int           next = 0;
  };
} // namespace PeriDeal
