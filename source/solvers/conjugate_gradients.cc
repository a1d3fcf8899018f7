// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/diverged.h>
#include <perideal/solvers/linear_solver.h>
#include <perideal/solvers/static_solver.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  namespace
  {
    /**
     * Nonlinear conjugate gradients (Polak-Ribiere, restarted where beta would be negative; Le 2014
     * eqs 2.45 to 2.49) with line searches for the zero of the force along the line by the secant
     * method. Where forces are linear one secant step is exact and gives the new residual, too: one
     * application an iteration.
     */
    class ConjugateGradients : public StaticSolver
    {
    public:
      ConjugateGradients(ElasticOperator &op, const StaticOptions &options)
        : op(op)
        , options(options)
      {
        for (Vector *v : {&residual, &last, &direction, &image, &trial, &correction})
          op.initialize_vector(*v);
        if (options.multigrid)
          prepare();
      }

      std::string name() const override
      {
        return "conjugate gradients";
      }

      void operator_changed() override
      {
        // It moves nodes that few bonds are left of far: line searches of large displacements do
        // not get on with that.
        if (op.nonlinear())
          preconditioner.reset();
        else if (preconditioner)
          prepare();
      }

      unsigned int solve(Vector &u, const double t, const double size) override
      {
        ResidualGoal goal(name(), options, size);
        RoundOffGoal round_off(op, options, size);
        op.distribute(u, t);
        op.residual(residual, u, t);
        direction      = 0.;
        double square  = 0.; // residual . P^-1 residual, of the last iteration
        step           = 0.;
        unsigned int n = 0;
        for (; !round_off.reached(residual, u, n) && !goal.reached(residual, n); ++n)
          {
            precondition();
            const double now  = residual * correction;
            const double beta = n == 0 ? 0. : std::max(0., (now - last * correction) / square);
            square            = now;
            direction.sadd(beta, 1., correction);
            if (residual * direction <= 0.) // no way down
              direction = correction;
            last = residual;
            search(u, t, n);
          }
        return n;
      }

    private:
      void prepare()
      {
        preconditioner = std::make_unique<MultigridPreconditioner>(op, options.direct_up_to);
        preconditioner->initialize(0., 1.);
      }

      void precondition()
      {
        if (preconditioner)
          preconditioner->vmult(correction, residual);
        else
          correction = residual;
      }

      /**
       * Go along the direction to where no force along it is left; residual becomes that of the new
       * u.
       */
      void search(Vector &u, const double t, const unsigned int n)
      {
        constexpr unsigned int refresh = 50; // sums of residuals lose digits
        const double           start   = residual * direction;
        if (step == 0. || !op.nonlinear())
          {
            op.apply(image, direction);
            const double curvature = direction * image;
            step                   = curvature > 0. ? start / curvature : 1.;
          }
        if (op.nonlinear())
          {
            search_secant(u, t, start);
            return;
          }
        u.add(step, direction);
        if (n % refresh == refresh - 1)
          op.residual(residual, u, t);
        else
          residual.add(-step, image);
      }

      void search_secant(Vector &u, const double t, const double start)
      {
        constexpr unsigned int most   = 8;
        constexpr double       enough = 1e-2, farthest = 4.;
        double                 below = 0., force_below = start, at = step;
        for (unsigned int k = 0; k < most; ++k)
          {
            trial = u;
            trial.add(at, direction);
            try
              {
                op.residual(residual, trial, t);
              }
            catch (const Diverged &failure) // on all processes
              {
                if (failure.trip.monitor != "inversion" || k + 1 == most)
                  throw;
                at = 0.5 * (below + at);
                continue;
              }
            const double force = residual * direction;
            // Also out if it is not finite: ResidualGoal says so.
            if (!(std::abs(force) > enough * start))
              break;
            const double slope = (force_below - force) / (at - below);
            const double next  = slope > 0. ? at + force / slope : farthest * at;
            below              = at;
            force_below        = force;
            at                 = std::min(std::max(next, at / farthest), farthest * at);
            if (at == below)
              break;
          }
        u    = trial;
        step = at;
      }

      ElasticOperator                         &op;
      const StaticOptions                      options;
      std::unique_ptr<MultigridPreconditioner> preconditioner;
      Vector                                   residual, last, direction, image, trial, correction;
      double                                   step = 0.;
    };
  } // namespace


  std::unique_ptr<StaticSolver> make_conjugate_gradients(ElasticOperator     &op,
                                                         const StaticOptions &options)
  {
    return std::make_unique<ConjugateGradients>(op, options);
  }
} // namespace PeriDeal
