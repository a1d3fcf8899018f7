// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/dofs/dof_handler.h>

#include <perideal/base/diverged.h>
#include <perideal/operators/interface/operator.h>
#include <perideal/problems/heat_ledger.h>
#include <perideal/solvers/motion_stepper.h>
#include <perideal/solvers/stepper.h>

#include <functional>
#include <string>
#include <vector>

namespace PeriDeal
{
  /** The smallest and the largest number of a vector. */
  struct Extent
  {
    double least = 0., most = 0.;
    bool   finite = true; // all of them; else the others mean nothing

    double width() const
    {
      return most - least;
    }

    /** The larger of both sizes. */
    double size() const;
  };

  /** In one pass and one reduction. Collective. */
  Extent extent_of(const Vector &u);

  /** Coordinates of an owned node of this process. */
  using PlaceOfNode = std::function<std::vector<double>(const unsigned int node)>;

  /** `(0.5, 0.25)` */
  std::string text_of_place(const std::vector<double> &place);

  /**
   * The entry for which @p size is largest, of all processes: its value and its place. Values that
   * are not finite are larger than any. Collective.
   * @param n_components of them stand at each node
   */
  struct Worst
  {
    double              value = 0., size = 0.; // 0: there is none
    std::vector<double> place;
  };
  Worst find_worst(const Vector                                    &u,
                   const unsigned int                               n_components,
                   const PlaceOfNode                               &place_of,
                   const std::function<double(const unsigned int)> &size);

  /** The monitor `finite values`. @param name of the field. Collective. */
  Trip values_not_finite(const Vector      &u,
                         const unsigned int n_components,
                         const PlaceOfNode &place_of,
                         const std::string &name,
                         const double       t);


  /**
   * The monitor `balance`: more than a hundredth is missing where nothing should. That is far above
   * what solvers and steps leave, and far below what would be seen.
   * @param what    has been found, with the number
   * @param of      the name of @p whole, of which so much is missing
   * Not collective.
   */
  Trip balance_broken(const std::string &what,
                      const double       missing,
                      const std::string &of,
                      const double       whole,
                      const double       t);

  /**
   * That monitor for what has come in since the start and what the body holds more than then; none
   * where K or C let heat get lost (K that are not symmetric, C of the temperature itself).
   * @param quantity as PhysicsNames::quantity
   * Not collective.
   */
  Trip heat_lost(const DiffusionOperator &op,
                 const HeatLedger        &ledger,
                 const std::string       &quantity,
                 const double             t);


  /**
   * Watches that the diffusing quantity does not grow by the steps alone. That costs a pass over
   * the values at each look. Where they have left the range that they had by as much again, an
   * application tells why:
   *
   * - `maximum principle`: nothing enters but through given values, and these are constant, so that
   *   no value may leave the range of the start;
   * - `growth`: in several looks what is far out gets farther, and is on its way back each time at
   *   a rate that only the fastest waves of the mesh have, |du/dt| > lambda/4 |u - m|, with lambda
   *   the largest eigenvalue and m the middle of the range. By its own equation it cannot have got
   *   there. Such waves change sign in each step, and their crests may lie farther out than their
   *   troughs: a look is compared with the one before the last, and one that is within the range
   *   between two that are not tells nothing.
   *
   * Values that loads or sources have brought there make a new range.
   */
  class GrowthGuard
  {
  public:
    /**
     * @param u     at time t, distributed or not
     * @param given where nothing enters but through given values, which are constant: the range of
     *              these, which no value may leave together with that of the start; else null
     * Collective.
     */
    Trip look(const DiffusionOperator &op,
              const Vector            &u,
              const double             t,
              const Extent            *given,
              const PlaceOfNode       &place_of,
              const std::string       &name);

    /** What is seen now has to be looked at after the next step again. */
    bool suspects() const
    {
      return n_suspicious > 0;
    }

  private:
    /** Whether a state that lies so far from the middle is farther out than two looks ago. */
    bool gets_farther(const double now);

    void forget_suspicion();

    /**
     * One more look without given values, with the extent @p now, which is beyond the range by as
     * much again or not.
     */
    bool grows_by_steps(const DiffusionOperator &op,
                        const Vector            &u,
                        const double             t,
                        const Extent            &now,
                        const bool               is_beyond,
                        const PlaceOfNode       &place_of,
                        Worst                   &worst);

    bool returns_too_fast(const DiffusionOperator &op,
                          const Vector            &u,
                          const double             t,
                          const PlaceOfNode       &place_of,
                          Worst                   &worst) const;

    bool         known = false;
    Extent       range;
    double       last_time    = 0.;
    unsigned int n_suspicious = 0;                    // looks
    bool         was_within   = true;                 // at the last look
    double       farthest = 0., farthest_before = 0.; // from the middle, at the last two looks
  };


  /**
   * Looks for the node in the cells, so that it is for what is said once. The handler has to
   * outlive this.
   */
  template <int dim>
  PlaceOfNode place_of_nodes(const dealii::DoFHandler<dim> &dofs);

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
  std::string cause_in_step(const Stepper     &stepper,
                            DiffusionOperator &op,
                            const Vector      &u,
                            const Trip        &trip);

  /** The same of a motion. K becomes the tangent at u. Collective. */
  std::string cause_in_motion(const MotionStepper &stepper, ElasticOperator &op, const Vector &u);

  /** Of balances that do not hold: solutions that are too rough; empty if they are not. */
  std::string cause_in_balance(const double solver_tolerance);

  /**
   * Nodes that hardly conduct beside others, or a K that lets values grow; empty if it does not.
   * Collective.
   */
  std::string cause_in_operator(Operator &op, const PlaceOfNode &place_of, const Trip &trip);

  /**
   * A cause of runs that diverge which lies in the body: a material that differs so much between
   * two cells side by side that solvers do not get across, or that the round-off of one is no less
   * than what the other takes part with. One pass over the cells. Collective.
   * @param entry    of the property, quoted, as `'Conductivity'`
   * @param property of a point, which may report errors of formulas
   * @param monitor  what has tripped: `solver` or `balance`
   * @return sentences; empty where it does not hold, and for other monitors
   */
  template <int dim>
  std::string cause_in_contrast(const dealii::Triangulation<dim>                        &mesh,
                                const std::string                                       &entry,
                                const std::function<double(const dealii::Point<dim> &)> &property,
                                const std::string                                       &monitor);
} // namespace PeriDeal
