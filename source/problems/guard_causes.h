// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/problems/guards.h>
#include <perideal/problems/problem.h>
#include <perideal/solvers/motion_stepper.h>
#include <perideal/solvers/stepper.h>

#include <string>

namespace PeriDeal
{
  /**
   * Looks for the node in the cells, so that it is for what is said once. The problem has to
   * outlive this.
   */
  template <int dim>
  PlaceOfNode place_of_nodes(const Problem<dim> &problem);

  /**
   * The monitor `step size`: steps that adapt have become so short that they lead nowhere. Those
   * at the start may be as short where nothing changes yet, but grow.
   */
  class StepGuard
  {
  public:
    /** After a step or some. Not collective, but the same on all processes. */
    Trip look(const Stepper &stepper, const double end_time, const double t);

  private:
    double             last_step = 0.;
    unsigned long long n_last    = 0; // steps then, rejected ones, too
    unsigned int       n_stuck   = 0; // looks that have found no growth
  };

  /**
   * Explicit steps above their limit for the values that there are, in sentences; empty if they are
   * not. @p op gets the material of the values. Collective.
   */
  std::string cause_in_step(const Stepper &stepper,
                            Operator      &op,
                            const Vector  &u,
                            const Trip    &trip);

  /** The same of a motion. K becomes the tangent at u. Collective. */
  std::string cause_in_motion(const MotionStepper &stepper, ElasticOperator &op, const Vector &u);

  /** Of balances that do not hold: solutions that are too rough; empty if they are not. */
  std::string cause_in_balance(const double solver_tolerance);

  /**
   * Nodes that hardly conduct beside others, or a K that lets values grow; empty if it does not.
   * Collective.
   */
  std::string cause_in_operator(Operator &op, const PlaceOfNode &place_of, const Trip &trip);
} // namespace PeriDeal
