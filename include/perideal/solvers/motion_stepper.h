// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/elastic_operator.h>
#include <perideal/solvers/stepper.h>
#include <perideal/solvers/work_of_forces.h>

#include <memory>
#include <string>
#include <vector>

namespace PeriDeal
{
  /** Energies of a moving body (J; in 2D per unit thickness). */
  struct MotionEnergy
  {
    double kinetic = 0., strain = 0.;
    double start    = 0.; // kinetic and strain energy at the start
    double work     = 0.; // of loads and supports since then
    double released = 0.; // by broken bonds since then

    /** What has come from nowhere: of order dt^2 with `verlet`, round-off of the linear solver with `newmark` and linear kinematics. */
    double imbalance() const
    {
      return kinetic + strain + released - start - work;
    }
  };


  /** Advances M d^2u/dt^2 = f(t) - K u, nonlinear or not, in time. Vectors are allocated once. */
  class MotionStepper
  {
  public:
    MotionStepper(ElasticOperator &op, const double dt);
    virtual ~MotionStepper() = default;

    /** The name used in scenes. */
    virtual std::string name() const = 0;

    /**
     * From u and v at time t to exactly t_end > t in equal steps of at most current_step(). u comes and goes distributed; prescribed unknowns have the velocity of
     * their last step. Throws UserError, with what to change, if values are not finite or the energy grows out of nothing. Collective.
     */
    void advance(Vector &u, Vector &v, const double t, const double t_end);

    /** Forget the past: operator, displacement or velocity have changed abruptly. */
    void restart();

    double current_step() const
    {
      return longest;
    }

    const StepperCost &cost() const
    {
      return spent;
    }

    /** Energies at time t; the start is that of the first advance(). Collective. */
    MotionEnergy energy(const Vector &u, const Vector &v) const;

  protected:
    /**
     * One step: u and v at t + dt, and unbalanced, which is that of u at t on entry, at t + dt. u and v keep their values at t in last and last_velocity,
     * which the caller has set.
     */
    virtual void step(Vector &u, Vector &v, const double t, const double dt) = 0;

    /** Bonds have broken: K is another one. */
    virtual void operator_changed() {}

    /** y = M^{-1} r on free unknowns, zero elsewhere. */
    void accelerate(Vector &y, const Vector &r) const;

    /** Velocity of the prescribed unknowns: that of the step. */
    void follow_supports(Vector &v, const Vector &u, const double dt) const;

    ElasticOperator          &op;
    const std::vector<double> inverse_mass;
    const std::vector<bool>   held; // prescribed
    Vector                    unbalanced, last, last_velocity;
    StepperCost               spent;

  private:
    void   begin(const Vector &u, const Vector &v, const double t);
    double kinetic_energy(const Vector &v, const bool supports_only) const;
    void   check(const Vector &v, const double t) const;

    const double longest;
    bool         started = false, fresh = true;
    double       start = 0., work = 0., effort = 0., support_start = 0.;
    Vector       change; // of a step
    WorkOfForces work_of_forces;
  };


  /** `auto`, `verlet` and `newmark`. */
  const std::vector<std::string> &motion_stepper_names();

  /** The longest stable step of `verlet`, 2/omega_max. Collective. */
  double stable_motion_step(const Operator &op);

  /**
   * The one factory; `auto` is `verlet`. A step that is not given is 0.8 of the stable one of `verlet`, with `newmark` 5 times it. Throws UserError
   * for a step of `verlet` above the stable one (with both numbers). Collective.
   */
  std::unique_ptr<MotionStepper> make_motion_stepper(const std::string    &name,
                                                     ElasticOperator      &op,
                                                     const StepperOptions &options);

  // One maker per method, each in its own file.
  std::unique_ptr<MotionStepper> make_verlet(ElasticOperator &op, const StepperOptions &options);
  std::unique_ptr<MotionStepper> make_newmark(ElasticOperator &op, const StepperOptions &options);
} // namespace PeriDeal
