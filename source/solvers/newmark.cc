// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/diverged.h>
#include <perideal/base/user_error.h>
#include <perideal/solvers/linear_solver.h>
#include <perideal/solvers/motion_stepper.h>
#include <perideal/solvers/static_solver.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace PeriDeal
{
  namespace
  {
    /**
     * Newmark's method with beta = 1/4, gamma = 1/2 (average acceleration): second order, stable
     * for any step, conserves the energy of linear bodies. Each step solves (4/dt^2 M + K) du = f -
     * K u - M a, again with K the tangent at the new u where forces are not linear (Newton).
     */
    class Newmark : public MotionStepper
    {
    public:
      Newmark(ElasticOperator &op, const StepperOptions &options)
        : MotionStepper(op, options.time_step, 0.)
        , tolerance(options.solver_tolerance)
        , solver(op, options.solver_tolerance, options.max_iterations, options.direct_up_to)
      {
        for (Vector *x : {&acceleration, &predicted, &residual, &change})
          op.initialize_vector(*x);
      }

      std::string name() const override
      {
        return "newmark";
      }

    protected:
      void step(Vector &u, Vector &v, const double t, const double dt) override
      {
        constexpr unsigned int most_of_contact = 20;
        const double           factor          = 4. / (dt * dt);
        last                                   = u;
        last_velocity                          = v;
        residual                               = unbalanced;
        op.clear_constrained(residual);
        const double before = residual.l2_norm();
        accelerate(acceleration, unbalanced);
        v.add(0.5 * dt, acceleration);
        u.add(dt, last_velocity);
        u.add(0.25 * dt * dt, acceleration);
        op.distribute(u, t + dt);
        predicted = u; // where the new acceleration would be zero
        op.unbalanced(unbalanced, u, t + dt);
        residual = unbalanced;
        op.clear_constrained(residual);
        const double size = std::max(before, residual.l2_norm());
        for (unsigned int round = 0;; ++round)
          {
            if (op.nonlinear())
              {
                op.linearize(u);
                if (round > 0)
                  solver.operator_changed();
              }
            change = 0.;
            solve_for_change(factor, t, dt);
            u += change;
            op.distribute(u, t + dt); // for unknowns that follow from others
            op.unbalanced(unbalanced, u, t + dt);
            if (!op.nonlinear())
              {
                // Of many rounds the last: nodes that go on to touch by turns.
                if (!find_touching(u) || round >= most_of_contact)
                  break;
                op.unbalanced(unbalanced, u, t + dt);
                find_residual(u, factor);
                continue;
              }
            find_residual(u, factor);
            if (is_small(size, u, round, t))
              break;
          }
        // Also to the solver's tolerance the acceleration of the forces, so that the next step
        // starts from them.
        accelerate(acceleration, unbalanced);
        v.add(0.5 * dt, acceleration);
        follow_supports(v, u, dt);
      }

      void operator_changed() override
      {
        solver.operator_changed();
      }

      void exchange_own(Archive &archive) override
      {
        solver.exchange(archive);
      }

    private:
      /** What is left of the residual by the change. */
      void solve_for_change(const double factor, const double t, const double dt)
      {
        try
          {
            spent.iterations += solver.solve(factor, 1., change, residual);
          }
        catch (const Diverged &failure)
          {
            // The mass holds every part: what is not solved is a tangent far from the solution.
            if (!op.nonlinear() || failure.trip.monitor != "solver")
              throw;
            std::ostringstream message;
            message << "Newton's iterations of the stepper 'newmark' did not converge at t = " << t
                    << ": their linear solver got to a relative residual of " << failure.trip.value
                    << " only. The body turns or deforms too much within a step of " << dt
                    << ": choose a smaller 'Time step' in section 'Time', or 'Stepper = verlet'.";
            throw Diverged(message.str(), "solver", failure.trip.value, failure.trip.bound, t);
          }
      }

      /** Forces less M a. */
      void find_residual(const Vector &u, const double factor)
      {
        for (unsigned int i = 0; i < held.size(); ++i)
          residual.local_element(i) =
            held[i] ?
              0. :
              unbalanced.local_element(i) -
                factor * (u.local_element(i) - predicted.local_element(i)) / inverse_mass[i];
      }

      bool is_small(const double size, const Vector &u, const unsigned int round, const double t)
      {
        constexpr unsigned int most = 30;
        const double           now  = residual.l2_norm();
        if (now <= std::max(10. * tolerance, 1e-12) * size || size == 0.)
          return true;
        // After large rotations round-off leaves more than that of small forces.
        const double last_change = change.l2_norm();
        change                   = u;
        change -= last;
        if (last_change <= std::max(tolerance, 1e-11) * change.l2_norm() ||
            (round >= most && now <= round_off_of_forces(op, u, size)))
          return true;
        std::ostringstream message;
        message << "Newton's iterations of the stepper 'newmark' did not converge at t = " << t
                << ". Choose a smaller 'Time step' in section 'Time', or 'Stepper = verlet'.";
        if (round >= most || !std::isfinite(now))
          throw Diverged(message.str(), "solver", now / size, std::max(10. * tolerance, 1e-12), t);
        return false;
      }

      const double tolerance;
      LinearSolver solver;
      Vector       acceleration, predicted, residual, change;
    };
  } // namespace


  std::unique_ptr<MotionStepper> make_newmark(ElasticOperator &op, const StepperOptions &options)
  {
    return std::make_unique<Newmark>(op, options);
  }
} // namespace PeriDeal
