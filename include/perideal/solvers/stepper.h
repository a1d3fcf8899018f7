// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/interface/diffusion_operator.h>
#include <perideal/solvers/findings.h>
#include <perideal/solvers/step_span.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace PeriDeal
{
  /** What a stepper has to know of the scene. */
  struct StepperOptions
  {
    double       time_step        = -1.; // negative: the stepper's own choice
    double       tolerance        = 1e-4;
    double       solver_tolerance = 1e-10;
    unsigned int max_iterations   = 1000;
    unsigned int direct_up_to     = 2000;
  };


  struct StepperCost
  {
    unsigned long long steps = 0, rejected = 0, iterations = 0;
    unsigned long long divided = 0, most_parts = 0; // given steps, and what one of them came to

    void exchange(Archive &archive)
    {
      archive.exchange("steps", steps);
      archive.exchange("rejected", rejected);
      archive.exchange("iterations", iterations);
      archive.exchange("divided", divided);
      archive.exchange("most parts", most_parts);
    }
  };


  /**
   * Advances C du/dt = f(t) - K u of a DiffusionOperator in time. Steppers allocate their vectors
   * once, in the constructor.
   */
  class Stepper
  {
  public:
    virtual ~Stepper() = default;

    /** The name used in scenes. */
    virtual std::string name() const = 0;

    /**
     * From u at time t to exactly t_end > t. u must be distributed at t, and comes back distributed
     * at t_end. Throws UserError as soon as values are no longer finite. Collective.
     */
    void advance(Vector &u, const double t, const double t_end, const AfterStep &after_step = {});

    /**
     * The rest of a span whose beginning was kept by exchange(), with the same steps as if there
     * had been no break; as advance(). Collective.
     */
    void go_on(Vector &u, const AfterStep &after_step = {});

    /** Within a span: there is a rest to go_on() with. */
    bool is_inside_span() const
    {
      return span.is_open;
    }

    /** Where that ends. */
    double end_of_span() const
    {
      return span.end;
    }

    /**
     * All that the next steps depend on besides u, which the caller keeps, and the operator. A
     * stepper that loads must be made as the one that saved, for an operator of the same scene at
     * the same time. @p keys those of u. Collective.
     */
    void exchange(Archive &archive, const NodeKeys &keys);

    /** Forget the past (multistep methods): the operator or the solution has changed abruptly. */
    virtual void restart() {}

    /** The time step used last or planned; 0 if there is none yet. */
    virtual double current_step() const = 0;

    /**
     * Predicted operator applications to advance over a time span; 0 if unknown. For the estimate
     * of a dry run.
     */
    virtual double expected_applications(const double time_span) const = 0;

    /**
     * take_step() changes neither u nor what exchange() keeps, cost and what has entered apart,
     * before its work is done: it may be left (LeavableStep).
     */
    virtual bool steps_can_be_left() const
    {
      return false;
    }

    /**
     * Of waves so fast that steps do not resolve them: what one of the steps may leave, as a factor
     * of their size; 0 where steps adapt, or damp them.
     */
    virtual double left_of_fast_waves() const
    {
      return 0.;
    }

    /** Bytes of this process's vectors. */
    virtual std::size_t memory_consumption() const
    {
      return 0;
    }

    const StepperCost &cost() const
    {
      return spent;
    }

    /** What has been found wrong so far: a given step above its limit. Not collective. */
    Findings &findings()
    {
      return found;
    }

    /**
     * What entered through sides and from sources in all time advanced so far, this process's
     * share: DiffusionOperator::entering() integrated by the method's own steps, as if it were one
     * more unknown, so that a linear operator which conserves heat keeps the balance to round-off.
     * Prescribed unknowns take up what their values need besides
     * (DiffusionOperator::heat_between()): that is added. Not collective.
     */
    double entered() const
    {
      return heat_entered;
    }

    /** Go on counting from what another stepper of the same run has had. */
    void carry_over(const StepperCost &before, const double entered_before)
    {
      spent.steps += before.steps;
      spent.rejected += before.rejected;
      spent.iterations += before.iterations;
      spent.divided += before.divided;
      spent.most_parts = std::max(spent.most_parts, before.most_parts);
      heat_entered += entered_before;
    }

  protected:
    /** Called with u at the start of the span; sets n_steps where steps are equal. */
    virtual void begin_span(const Vector &u) = 0;

    /** One step of u from span.now, which is set to where it ends: where it began if rejected. */
    virtual void take_step(Vector &u) = 0;

    /** Called with u after the last step. */
    virtual void end_span(Vector &u) = 0;

    /** What this method has besides the members here. */
    virtual void exchange_own(Archive &, const NodeKeys &) {}

    StepSpan    span;
    StepperCost spent;
    Findings    found;
    double      heat_entered = 0.;
  };


  /** All names that a scene may give, `auto` first. */
  const std::vector<std::string> &stepper_names();

  /** Those of them that do not solve systems, and need a diagonal C. */
  std::vector<std::string> explicit_stepper_names();

  /**
   * `auto`: the Chebyshev expansion of the exponential where it applies (symmetric K, diagonal C,
   * material, loads and boundary values constant in time), adaptive RKC2 where C is diagonal, else
   * SDIRK2.
   */
  std::string choose_stepper(const DiffusionOperator &op);

  /**
   * The one factory. Throws UserError for a stepper that the operator does not allow, and for a
   * step above the stability bound (with both bounds in the message). Collective.
   */
  std::unique_ptr<Stepper> make_stepper(const std::string    &name,
                                        DiffusionOperator    &op,
                                        const StepperOptions &options);

  /**
   * Largest stable step of an explicit method (`euler` 2/lambda, `rk4` 2.785/lambda); infinite for
   * all others: stability_limit() over the eigenvalue.
   */
  double stable_step(const std::string &name, const double largest_eigenvalue);

  /**
   * Throws UserError, with both bounds in the message, for a step of an explicit method above the
   * stability bound. Collective.
   */
  void refuse_unstable_step(const std::string &name, const DiffusionOperator &op, const double dt);

  // One maker per family of methods, each in its own file.
  std::unique_ptr<Stepper> make_euler(DiffusionOperator &op, const StepperOptions &options);
  std::unique_ptr<Stepper> make_rk4(DiffusionOperator &op, const StepperOptions &options);
  std::unique_ptr<Stepper> make_rkc2(DiffusionOperator &op, const StepperOptions &options);
  /** With so many stages in each step, two or more, whether that is stable or not. */
  std::unique_ptr<Stepper> make_rkc2(DiffusionOperator    &op,
                                     const StepperOptions &options,
                                     const unsigned int    n_stages);
  std::unique_ptr<Stepper> make_chebyshev(DiffusionOperator &op, const StepperOptions &options);
  std::unique_ptr<Stepper> make_crank_nicolson(DiffusionOperator    &op,
                                               const StepperOptions &options);
  std::unique_ptr<Stepper> make_bdf2(DiffusionOperator &op, const StepperOptions &options);
  std::unique_ptr<Stepper> make_sdirk2(DiffusionOperator &op, const StepperOptions &options);
} // namespace PeriDeal
