// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/diverged.h>
#include <perideal/solvers/linear_solver.h>
#include <perideal/solvers/static_solver.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace PeriDeal
{
  namespace
  {
    /**
     * Newton's method: linear systems with the tangent, solved only as far as the iterations come
     * near (Eisenstat and Walker 1996), by conjugate gradients whose multigrid is made for the
     * first tangent and kept while it serves. Where a full step would go too far, which the
     * residual along it tells, it is shortened; where forces have an energy it is lower then.
     */
    class Newton : public StaticSolver
    {
    public:
      Newton(ElasticOperator &op, const StaticOptions &options)
        : op(op)
        , options(options)
        , solver(op, options.tolerance, options.max_iterations, options.direct_up_to)
      {
        for (Vector *v : {&residual, &change, &start})
          op.initialize_vector(*v);
      }

      std::string name() const override
      {
        return "newton";
      }

      void operator_changed() override
      {
        solver.operator_changed();
      }

      void exchange(Archive &archive) override
      {
        archive.exchange("Newton iterations", n_systems);
        solver.exchange(archive);
      }

      unsigned int n_newton_iterations() const override
      {
        return n_systems;
      }

      /** Iterations are those of the linear systems. */
      unsigned int solve(Vector &u, const double t, const double size) override
      {
        try
          {
            return find_equilibrium(u, t, size);
          }
        catch (const Diverged &failure)
          {
            if (failure.trip.monitor == "law") // which says all of it
              throw;
            std::ostringstream message;
            message
              << "'Solver = newton' in section 'Elasticity' found no equilibrium at t = " << t
              << ". The loads may be more than the body bears: beyond a limit load there is none. Prescribe 'Displacement' in section 'Boundary conditions' in place of 'Traction', or try a "
                 "smaller 'Time step' in section 'Time'. What the iterations said: "
              << failure.message();
            throw Diverged(message.str(),
                           failure.trip.monitor,
                           failure.trip.value,
                           failure.trip.bound,
                           t);
          }
      }

    private:
      unsigned int find_equilibrium(Vector &u, const double t, const double size)
      {
        StaticOptions of_steps  = options;
        of_steps.max_iterations = std::min(options.max_iterations, most_steps);
        ResidualGoal goal(name(), of_steps, size);
        RoundOffGoal round_off(op, of_steps, size);
        op.distribute(u, t);
        op.residual(residual, u, t);
        const double scale = size > 0. ? size : residual.l2_norm();
        double       last = std::numeric_limits<double>::infinity(), share = roughest;
        unsigned int n_iterations = 0;
        for (unsigned int n = 0; !round_off.reached(residual, u, n) && !goal.reached(residual, n);
             ++n)
          {
            const double now = residual.l2_norm();
            // Steps that go on from round-off find no less.
            if (n > 1 && now > 0.5 * last && now <= round_off_of_forces(op, u, scale))
              {
                accept_residual(now / scale);
                break;
              }
            share = n == 0 ? roughest : share_of(now / last, share);
            last  = now;
            op.linearize(u);
            solver.operator_changed();
            change = 0.;
            // No more than what the last step wants.
            const double wanted = std::max(share * now, 0.3 * options.tolerance * scale);
            n_iterations += solver.solve(0., 1., change, residual, wanted / options.tolerance);
            ++n_systems;
            search(u, t);
          }
        return n_iterations;
      }

      static constexpr unsigned int most_steps = 100;
      static constexpr double       roughest   = 1e-2;

      /** Of the residual that the next linear solution may leave: it shall not hold back. */
      static double share_of(const double ratio, const double before)
      {
        const double wanted = 0.9 * ratio * ratio, safeguard = 0.9 * before * before;
        return std::clamp(safeguard > 0.1 ? std::max(wanted, safeguard) : wanted, 1e-6, roughest);
      }

      /** The step, or as much of it as the force along it is not much reversed. */
      void search(Vector &u, const double t)
      {
        constexpr unsigned int most = 10;
        constexpr double       far = 0.9, shortest = 0.1;
        const double           before = residual * change;
        start                         = u;
        double at = 1., below = 0., force_below = before;
        for (unsigned int k = 0;; ++k)
          {
            u = start;
            u.add(at, change);
            op.distribute(u, t);
            try
              {
                op.residual(residual, u, t);
              }
            catch (const Diverged &failure) // on all processes
              {
                if (failure.trip.monitor != "inversion" || k == most)
                  throw;
                at = 0.5 * (below + at);
                continue;
              }
            const double force = residual * change;
            // Out also where no energy says how far to go, and where the force is not finite:
            // ResidualGoal says so.
            if (!(before > 0.) || !(std::abs(force) > far * before) || k == most)
              return;
            const double next = at - force * (at - below) / (force - force_below);
            if (force > 0.)
              {
                below       = at;
                force_below = force;
                at          = std::min(std::max(next, 1.2 * at), 4. * at);
              }
            else
              at = std::max(below + shortest * (at - below), std::min(next, 0.9 * at));
          }
      }

      ElasticOperator    &op;
      const StaticOptions options;
      LinearSolver        solver;
      Vector              residual, change, start;
      unsigned int        n_systems = 0; // solved so far
    };
  } // namespace


  std::unique_ptr<StaticSolver> make_newton(ElasticOperator &op, const StaticOptions &options)
  {
    return std::make_unique<Newton>(op, options);
  }
} // namespace PeriDeal
