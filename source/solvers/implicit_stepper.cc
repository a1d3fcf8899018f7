// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "implicit_stepper.h"

#include <perideal/base/progress.h>
#include <perideal/solvers/step_tools.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace PeriDeal
{
  namespace
  {
    /** Of the material's dependence on the temperature; shorter steps need fewer. */
    struct RoundsSpent : Diverged
    {
      using Diverged::Diverged;
    };
  } // namespace


  void ImplicitStepper::take_step(Vector &u)
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
        if (fixed ? n_parts() == most_parts : ++n_shortened > most)
          throw;
        ++spent.rejected;
        if (!fixed)
          dt = 0.25 * h;
        else
          {
            span.n_steps *= 2;
            span.n_done      = 2 * span.n_done - 1; // go_on() counts this one
            spent.most_parts = std::max(spent.most_parts, n_parts());
          }
        return;
      }
    n_shortened   = 0;
    double growth = 1.;
    if (!fixed && order > 0)
      {
        const double size = estimated_error(u, t, h, order);
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
    else if (const unsigned long long n = n_parts(), done = span.n_done + 1; n > 1)
      {
        const bool ends = done % n == 0; // a given step
        spent.divided += ends;
        if (ends || done % 4 == 0)
          {
            span.n_steps /= 2;
            span.n_done = done / 2 - 1; // go_on() counts this one
          }
      }
  }


  double ImplicitStepper::solve_stage(const Vector &u,
                                      const Vector &w,
                                      const double  s,
                                      const double  t,
                                      Vector       &U)
  {
    // Picard iterations if the material depends on the solution, which is taken at the last
    // iterate, and Newton's for sides and sources.
    constexpr unsigned int most = 60;
    const double           goal = std::max(1e-4 * tolerance, 1e-14); // above round-off
    chord.start();
    double wanted = 0.;
    for (unsigned int k = 0; k < most; ++k)
      {
        const double before = solve_once(u, w, s, t, wanted, U);
        if (k == 0 && !op.capacity_depends_on_solution()) // later rounds need no more digits
          wanted = before;
        if (!op.depends_on_solution() || capacity_norm(op, change) <= goal * capacity_norm(op, U))
          {
            op.residual(residual, U, t);
            return op.entering();
          }
      }
    std::ostringstream message;
    message
      << "'Stepper = " << method
      << "' in section 'Time': the iterations for the dependence on the temperature (T in section 'Material', in what enters through sides or in 'Source') did not "
         "converge in "
      << most << " rounds near t = " << t;
    if (fixed)
      message << ", in steps of 1/" << n_parts() << " of 'Time step'";
    message << ". Choose a smaller 'Time step' or 'Tolerance', or 'Stepper = rkc2'.";
    throw RoundsSpent(message.str(),
                      "solver",
                      capacity_norm(op, change),
                      goal * capacity_norm(op, U),
                      t);
  }


  double ImplicitStepper::solve_once(const Vector &u,
                                     const Vector &w,
                                     const double  s,
                                     const double  t,
                                     const double  wanted,
                                     Vector       &U)
  {
    op.distribute(U, t);
    if (op.depends_on_solution())
      {
        op.take_material_at(U, t);
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
    change              = 0.;
    const double before = residual.l2_norm();
    spent.iterations += solver.solve(1., s, change, residual, wanted, more);
    U += change;
    op.distribute(U, t);
    return before;
  }


  void ImplicitStepper::sdirk2(const Vector &u,
                               const double  t,
                               const double  h,
                               Vector       &k1,
                               Vector       &k2)
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


  double ImplicitStepper::estimated_error(const Vector &u,
                                          const double  t,
                                          const double  h,
                                          const int     order)
  {
    op.clear_constrained(error);
    constexpr double share = 0.01;
    const double     old = capacity_norm(op, u), now = capacity_norm(op, next);
    double           level = std::max(old, now);
    // A body at 0, where a source begins within the step: against what that makes until the end.
    if (old == 0.)
      level = std::max(level, share * now * (span.end - t) / h);
    const double bound = (order == 3 ? third_order_tolerance : tolerance) * level;
    const double size  = level == 0. ? 0. : capacity_norm(op, error) / bound;
    if (!std::isfinite(size))
      throw not_finite(unstable_message(t), t);
    return size;
  }


  std::string ImplicitStepper::unstable_message(const double t) const
  {
    std::ostringstream message;
    message << "The run became unstable: stepper '" << method
            << "' produced values that are not finite near t = " << t
            << ". Check loads and boundary values in time.";
    return message.str();
  }
} // namespace PeriDeal
