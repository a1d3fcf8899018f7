// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/interface/diffusion_operator.h>
#include <perideal/solvers/heat_steps.h>
#include <perideal/solvers/linear_solver.h>
#include <perideal/solvers/step_tools.h>
#include <perideal/solvers/stepper.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace PeriDeal
{
  /**
   * Between two iterates of a stage, what an unknown takes up per degree: the slope of the chord of
   * its heat over its temperature, where C(T) is that of the tangent. Where the capacity jumps, as
   * at both ends of a latent heat, Newton's iterations go to and fro between two tangents; chords
   * lead into the bend between them.
   */
  class SecantCapacity
  {
  public:
    /** Forget the iterates of the stage before. */
    void start()
    {
      n_seen = 0;
    }

    /**
     * See an iterate and the heat that it has more than the beginning of the step. Returns what
     * the capacity of the chord has more than that of the operator, or nullptr while tangents may
     * do.
     */
    const Vector *see(const DiffusionOperator &op, const Vector &iterate, const Vector &heat)
    {
      constexpr unsigned int by_tangents = 4;
      ++n_seen;
      if (n_seen <= by_tangents)
        {
          keep(iterate, heat);
          return nullptr;
        }
      more = 0.;
      for (unsigned int i = 0; i < iterate.locally_owned_size(); ++i)
        {
          const double way  = iterate.local_element(i) - last.local_element(i),
                       gain = heat.local_element(i) - last_heat.local_element(i),
                       size =
                         std::abs(heat.local_element(i)) + std::abs(last_heat.local_element(i));
          if (way * gain > 0. && std::abs(gain) > 1e-10 * size) // above round-off
            more.local_element(i) = gain / way - op.lumped_capacity().local_element(i);
        }
      keep(iterate, heat);
      return &more;
    }

  private:
    void keep(const Vector &iterate, const Vector &heat)
    {
      last      = iterate;
      last_heat = heat;
      if (more.size() == 0)
        more.reinit(iterate, true);
    }

    unsigned int n_seen = 0;
    Vector       last, last_heat, more;
  };


  /**
   * What the implicit methods share: the solve for a stage, and fixed or adaptive steps around a
   * method's single step. A fixed step whose rounds are spent goes on in parts of half the length,
   * a quarter and so on, the same on all processes; where parts have done, longer ones follow.
   */
  class ImplicitStepper : public Stepper
  {
  public:
    ImplicitStepper(DiffusionOperator &op, const StepperOptions &options, const std::string &method)
      : op(op)
      , fixed(options.time_step > 0.)
      , method(method)
      , dt(fixed ? options.time_step : 0.)
      , tolerance(options.tolerance)
      , third_order_tolerance(local_tolerance(options.tolerance))
      , solver(op, options.solver_tolerance, options.max_iterations, options.direct_up_to)
      , held(op)
    {
      for (Vector *v : {&next, &error, &base, &residual, &change, &offset, &known, &taken})
        op.initialize_vector(*v);
    }

    std::string name() const override
    {
      return method;
    }

    bool steps_can_be_left() const override
    {
      return true;
    }

    double current_step() const override
    {
      return dt;
    }

    double expected_applications(const double time_span) const override
    {
      return fixed ? 15. * static_cast<double>(n_equal_steps(time_span, dt)) : 0.;
    }

    void restart() override
    {
      solver.operator_changed();
    }

    /** The largest product of a fixed step and an eigenvalue; 0 where steps adapt. */
    double largest_rate() const
    {
      return fixed ? dt * op.spectrum().sharp : 0.;
    }

  protected:
    void begin_span(const Vector &u) override
    {
      held.begin(u);
      const double length = span.end - span.start;
      if (fixed)
        span.n_steps = n_equal_steps(length, dt);
      else if (dt == 0.)
        dt = std::min(1e-3 * length, 2. / op.spectrum().sharp);
    }

    void take_step(Vector &u) override;

    void end_span(Vector &u) override
    {
      op.distribute(u, span.end);
      check_finite(u, method, span.end);
      heat_entered += held.taken(u);
    }

    void exchange_own(Archive &archive, const NodeKeys &keys) override
    {
      archive.exchange("time step", dt);
      archive.exchange("taken", taken, keys);
      held.exchange(archive, keys);
      solver.exchange(archive);
    }

    /**
     * One step of size h from u at t into `next`, what enters meanwhile into `step_heat`; the
     * local error estimate into `error`. Returns the order of the estimate in h, 0 if there is
     * none yet.
     */
    virtual int step(const Vector &u, const double t, const double h) = 0;

    /** The step is good: keep what the next one needs. u is still the old value. */
    virtual void accept(const Vector &, const double) {}

    /**
     * Solve C (U - w) = s (f(t) - K U): the start of the iteration is in U, w and s > 0 belong to
     * the method. Where C depends on the solution, solve instead for the heat that U has more
     * than u, H(U) - H(u) = known + s (f(t) - K U), so that the steps keep it. Returns what
     * enters per time with U.
     */
    double solve_stage(const Vector &u, const Vector &w, const double s, const double t, Vector &U);

    /**
     * One round, up to the solver's tolerance times @p wanted, 0: times the residual. Returns the
     * residual before it.
     */
    double solve_once(const Vector &u,
                      const Vector &w,
                      const double  s,
                      const double  t,
                      const double  wanted,
                      Vector       &U);

    /** SDIRK2 (gamma = 1 - 1/sqrt 2, L-stable) into `next`; the stage rates into k1, k2. */
    void sdirk2(const Vector &u, const double t, const double h, Vector &k1, Vector &k2);

    DiffusionOperator &op;
    const bool         fixed; // steps, as far as rounds allow
    Vector             next, error, base;
    Vector known, taken; // see solve_stage(); what the unknowns took up in the last step
    double step_heat = 0.;

  private:
    static constexpr unsigned long long most_parts = 1ULL << 16;

    /** How many of the present parts make a fixed step: one, unless its rounds are spent. */
    unsigned long long n_parts() const
    {
      return span.n_steps / n_equal_steps(span.end - span.start, dt);
    }

    /** Of the step of size h from u at t to `next`, as a multiple of what is allowed. */
    double estimated_error(const Vector &u, const double t, const double h, const int order);

    std::string unstable_message(const double t) const;

    const std::string method;
    double            dt;
    const double      tolerance, third_order_tolerance; // of the estimated errors of a step
    LinearSolver      solver;
    Vector            residual, change, offset;
    HeldHeat          held;
    SecantCapacity    chord;
    unsigned int      n_shortened = 0; // since a step was taken
  };
} // namespace PeriDeal
