// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/diverged.h>
#include <perideal/base/progress.h>
#include <perideal/solvers/heat_steps.h>
#include <perideal/solvers/linear_solver.h>
#include <perideal/solvers/step_tools.h>
#include <perideal/solvers/stepper.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>

#include "secant_capacity.h"

namespace PeriDeal
{
  /** Of the material's dependence on the temperature; shorter steps need fewer. */
  struct RoundsSpent : Diverged
  {
    using Diverged::Diverged;
  };


  /**
   * What the implicit methods share: the solve for a stage, and fixed or adaptive steps around a
   * method's single step.
   */
  class ImplicitStepper : public Stepper
  {
  public:
    ImplicitStepper(Operator &op, const StepperOptions &options, const std::string &method)
      : op(op)
      , method(method)
      , fixed(options.time_step > 0.)
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

    void take_step(Vector &u) override
    {
      const double t = span.now, t_end = span.end;
      const bool   lands = fixed ? span.n_done + 1 == span.n_steps : t + dt * (1. + 1e-10) >= t_end;
      const double h     = fixed ? (t_end - span.start) / static_cast<double>(span.n_steps) :
                           lands ? t_end - t :
                                   std::min(dt, 0.5 * (t_end - t) + 0.5 * dt);
      int          order = 0;
      try
        {
          order = step(u, t, h);
        }
      catch (const RoundsSpent &)
        {
          constexpr unsigned int most = 30;
          if (fixed || ++n_shortened > most)
            throw;
          ++spent.rejected;
          dt = 0.25 * h;
          return;
        }
      n_shortened   = 0;
      double growth = 1.;
      if (!fixed && order > 0)
        {
          const double size = estimated_error(u, t, order);
          growth            = std::clamp(0.85 * std::pow(std::max(size, 1e-12), -1. / order),
                              0.2,
                              2.); // BDF2 is stable for ratios up to 1 + sqrt 2
          if (size > 1.)
            {
              ++spent.rejected;
              dt = h * std::min(growth, 0.9);
              return;
            }
        }
      heat_entered += step_heat;
      if (op.capacity_depends_on_solution())
        {
          op.heat_between(taken, u, next);
          heat_entered += sum_of_held(op, taken, offset);
        }
      accept(u, h);
      u        = next;
      span.now = lands ? t_end : fixed ? span.start + (span.n_done + 1) * h : t + h;
      ++spent.steps;
      tell_step(span.now);
      if (!fixed)
        dt = lands ? std::max(dt, h * growth) : h * growth;
    }

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
    double solve_stage(const Vector &u, const Vector &w, const double s, const double t, Vector &U)
    {
      // Picard iterations if the material depends on the solution: it is taken at the last
      // iterate.
      constexpr unsigned int most = 60;
      const double           goal = std::max(1e-4 * tolerance, 1e-14); // above round-off
      chord.start();
      for (unsigned int k = 0; k < most; ++k)
        {
          solve_once(u, w, s, t, U);
          if (!op.depends_on_solution() || capacity_norm(op, change) <= goal * capacity_norm(op, U))
            {
              op.residual(residual, U, t);
              return op.entering();
            }
        }
      std::ostringstream message;
      message
        << "'Stepper = " << method
        << "' in section 'Time': the iterations for the material's dependence on the temperature (T in section 'Material') did not "
           "converge in "
        << most << " rounds near t = " << t
        << ". Choose a smaller 'Time step' or 'Tolerance', or 'Stepper = rkc2'.";
      throw RoundsSpent(message.str(),
                        "solver",
                        capacity_norm(op, change),
                        goal * capacity_norm(op, U),
                        t);
    }

    void solve_once(const Vector &u, const Vector &w, const double s, const double t, Vector &U)
    {
      op.distribute(U, t);
      if (op.depends_on_solution())
        {
          op.take_material_at(U);
          op.distribute(U, t);
          solver.operator_changed();
        }
      op.residual(residual, U, t);
      const Vector *more = nullptr;
      if (op.capacity_depends_on_solution())
        {
          op.heat_between(change, u, U);
          if (op.capacity_is_diagonal())
            more = chord.see(op, U, change);
          change.sadd(-1., 1., known);
        }
      else
        {
          for (unsigned int i = 0; i < w.locally_owned_size(); ++i)
            offset.local_element(i) = w.local_element(i) - U.local_element(i);
          op.apply_capacity(change, offset);
        }
      op.clear_constrained(change);
      residual.sadd(s, 1., change);
      change = 0.;
      spent.iterations += solver.solve(1., s, change, residual, 0., more);
      U += change;
      op.distribute(U, t);
    }

    /** SDIRK2 (gamma = 1 - 1/sqrt 2, L-stable) into `next`; the stage rates into k1, k2. */
    void sdirk2(const Vector &u, const double t, const double h, Vector &k1, Vector &k2)
    {
      const double gamma = 1. - std::sqrt(0.5);
      next               = u;
      known              = 0.;
      const double first = solve_stage(u, u, gamma * h, t + gamma * h, next);
      if (op.capacity_depends_on_solution())
        {
          op.heat_between(known, u, next);
          known *= (1. - gamma) / gamma;
        }
      for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
        {
          k1.local_element(i)   = (next.local_element(i) - u.local_element(i)) / (gamma * h);
          base.local_element(i) = u.local_element(i) + (1. - gamma) * h * k1.local_element(i);
        }
      const double second = solve_stage(u, base, gamma * h, t + h, next);
      step_heat           = h * ((1. - gamma) * first + gamma * second);
      for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
        k2.local_element(i) = (next.local_element(i) - base.local_element(i)) / (gamma * h);
    }

    Operator &op;
    Vector    next, error, base;
    Vector    known, taken; // see solve_stage(); what the unknowns took up in the last step
    double    step_heat = 0.;

  private:
    /** Of the step from u to `next`, as a multiple of what is allowed. */
    double estimated_error(const Vector &u, const double t, const int order)
    {
      op.clear_constrained(error);
      const double level = std::max(capacity_norm(op, u), capacity_norm(op, next));
      const double bound = (order == 3 ? third_order_tolerance : tolerance) * level;
      const double size  = level == 0. ? 0. : capacity_norm(op, error) / bound;
      if (!std::isfinite(size))
        throw not_finite(unstable_message(t), t);
      return size;
    }

    std::string unstable_message(const double t) const
    {
      std::ostringstream message;
      message << "The run became unstable: stepper '" << method
              << "' produced values that are not finite near t = " << t
              << ". Check loads and boundary values in time.";
      return message.str();
    }

    const std::string method;
    const bool        fixed;
    double            dt;
    const double      tolerance, third_order_tolerance; // of the estimated errors of a step
    LinearSolver      solver;
    Vector            residual, change, offset;
    HeldHeat          held;
    SecantCapacity    chord;
    unsigned int      n_shortened = 0; // since a step was taken
  };
} // namespace PeriDeal
