// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/archive.h>
#include <perideal/operators/solid/elastic_operator.h>
#include <perideal/solvers/findings.h>
#include <perideal/solvers/motion_energy.h>
#include <perideal/solvers/stepper.h>

#include <memory>
#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * Watches that the steps of an explicit motion stay stable while the body deforms and breaks: the
   * limit 2/omega_max is that of the tangent, which changes with the directions and forces of the
   * bonds. Looking (ElasticOperator::stepping) costs half an application where bonds are
   * those of the deformed body, else nothing; a new estimate, by Lanczos iterations, some thirty.
   * There is one only when the largest stretch has changed much, bonds have broken or cracks have
   * grown since the last, and only as long as all of them together take at most some percent of
   * the applications, or the body has stretched far since.
   */
  class StepLimit
  {
  public:
    /**
     * @param op is referred to; @param step the first one, stable for the K that it has now;
     *           @param may_change else the user has given it
     */
    StepLimit(ElasticOperator &op, const double step, const bool may_change);

    /**
     * The step to go on with from u at time t, after so many steps: smaller where the old one would
     * be above nine tenths of the limit, longer again, up to the first, once the deformation has
     * gone. Throws UserError where a given step is above the limit. K becomes the tangent at u if
     * the limit is estimated. Collective.
     */
    double follow(const Vector &u, const double t, const unsigned long long n_steps);

    /** Its last estimate, and what all have taken. Collective. */
    void exchange(Archive &archive);

    /** 0.8 of the limit: what is chosen for the user. */
    static constexpr double share = 0.8;

  private:
    double estimate(const Vector &u);

    ElasticOperator   &op;
    const double       first;
    const bool         may_change;
    double             step, stretch   = 0.; // those of the last estimate
    unsigned long long n_broken, spent = 0;
    double             next_growth; // of cracks, after the last estimate
  };


  /** Advances M d^2u/dt^2 = f(t) - K u, nonlinear or not, in time. Vectors are allocated once. */
  class MotionStepper
  {
  public:
    /** @param c steps of linear bodies conserve the energy H - c dt^2 a.Ma */
    MotionStepper(ElasticOperator &op, const double dt, const double c);
    virtual ~MotionStepper() = default;

    /** The name used in scenes. */
    virtual std::string name() const = 0;

    /**
     * From u and v at time t to exactly t_end > t in equal steps of at most current_step(), which
     * may change on the way. u comes and goes distributed; prescribed unknowns have the velocity of
     * their last step. Throws UserError, with what to change, if values are not finite, and what
     * examine() throws, which is asked now and then. Collective.
     */
    void advance(Vector          &u,
                 Vector          &v,
                 const double     t,
                 const double     t_end,
                 const AfterStep &after_step = {});

    /**
     * The rest of a span whose beginning was kept by exchange(), with the same steps as if there
     * had been no break; as advance(). Collective.
     */
    void go_on(Vector &u, Vector &v, const AfterStep &after_step = {});

    /** Within a span: there is a rest to go_on() with. */
    bool is_inside_span() const
    {
      return span.is_open;
    }

    /**
     * All that the next steps depend on besides u and v, which the caller keeps, and the operator.
     * A stepper that loads must be made as the one that saved. Collective.
     */
    void exchange(Archive &archive, const NodeKeys &keys);

    /**
     * Throws UserError, with what to change, if the drift of the energy is more than allowed_drift
     * of what start and loads have brought in, the body of full kinematics is inside out, or a
     * given step is no longer stable. Costs two applications at most. Collective.
     */
    void examine(const Vector &u, const Vector &v, const double t);

    static constexpr double allowed_drift = 0.01;

    /** Let the step follow the body, or refuse one that has been given and no longer is stable. */
    void set_limit(std::unique_ptr<StepLimit> limit);

    /**
     * Another stepper of the same operator breaks its bonds and lets its cracks grow, and tells
     * this one to restart().
     */
    void leave_bonds()
    {
      leaves_bonds = true;
    }

    /** Forget the past: operator, displacement or velocity have changed abruptly. */
    void restart();

    double current_step() const
    {
      return longest;
    }

    /** The shortest of all that current_step() has been. */
    double shortest_step() const
    {
      return shortest;
    }

    const StepperCost &cost() const
    {
      return spent;
    }

    /** What examine() and the steps have found wrong so far. Not collective. */
    Findings &findings()
    {
      return found;
    }

    /** Energies at time t; the start is that of the first advance(). Collective. */
    MotionEnergy energy(const Vector &u, const Vector &v) const;

  protected:
    /**
     * One step: u and v at t + dt, and unbalanced, which is that of u at t on entry, at t + dt. It
     * keeps their values at t in last and, where forces are not linear, in last_velocity.
     */
    virtual void step(Vector &u, Vector &v, const double t, const double dt) = 0;

    /** Bonds have broken, or cracks have grown: K is another one. */
    virtual void operator_changed() {}

    /** As exchange(), of what a method has beyond that. */
    virtual void exchange_own(Archive &) {}

    /** ElasticOperator::update_contact(). What begins or ceases to touch makes energy. */
    bool find_touching(const Vector &u)
    {
      const bool changes = op.update_contact(u);
      has_touched        = has_touched || changes;
      return changes;
    }

    /** y = M^{-1} r on free unknowns, zero elsewhere. */
    void accelerate(Vector &y, const Vector &r) const;

    /** Velocity of the prescribed unknowns: that of the step. */
    void follow_supports(Vector &v, const Vector &u, const double dt) const;

    ElasticOperator                &op;
    const std::vector<double>       inverse_mass;
    const std::vector<bool>         held;              // prescribed
    const std::vector<double>       free_inverse_mass; // 0 where prescribed
    const std::vector<unsigned int> supports;          // those that are prescribed
    Vector                          unbalanced, last, last_velocity;
    StepperCost                     spent;
    Findings                        found;

  private:
    void begin(const Vector &u, const Vector &v, const double t);
    void take_step(Vector &u, Vector &v);
    void look_after(const Vector &u, const Vector &v);
    void check(const Vector &v, const double t);
    void check_drift(const Vector &u, const Vector &v, const double t);
    void check_inversion(const Vector &u, const double t);
    bool follow_body(const Vector &u, const double t);
    void change_bonds(const Vector &u, const double t);

    StepSpan                   span;
    double                     longest, shortest;
    std::unique_ptr<StepLimit> limit; // null: none
    bool                       fresh = true, leaves_bonds = false, has_touched = false;
    Vector                     change; // of a step
    MotionAccount              account;
  };


  template <int dim>
  struct Scene;

  /**
   * Throws UserError for a `Stepper` for motion in a scene of any physics in which there is none,
   * for others in one of a solid, and for a motion that shall be steady. Not collective.
   */
  template <int dim>
  void require_stepper(const Scene<dim> &scene);

  /** `auto`, `verlet` and `newmark`. */
  const std::vector<std::string> &motion_stepper_names();

  /** The longest stable step of `verlet`, 2/omega_max. Collective. */
  double stable_motion_step(const Operator &op);

  /**
   * The one factory; `auto` is `verlet`. A step that is not given is 0.8 of the stable one of
   * `verlet`, with `newmark` 5 times it. Throws UserError for a step of `verlet` above the stable
   * one (with both numbers), and for nodes without mass. Collective.
   */
  std::unique_ptr<MotionStepper> make_motion_stepper(const std::string    &name,
                                                     ElasticOperator      &op,
                                                     const StepperOptions &options);

  // One maker per method, each in its own file.
  std::unique_ptr<MotionStepper> make_verlet(ElasticOperator &op, const StepperOptions &options);
  std::unique_ptr<MotionStepper> make_newmark(ElasticOperator &op, const StepperOptions &options);
} // namespace PeriDeal
