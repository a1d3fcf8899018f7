// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/diverged.h>
#include <perideal/base/user_error.h>
#include <perideal/solvers/floating_part.h>
#include <perideal/solvers/linear_solver.h>
#include <perideal/solvers/static_solver.h>

#include <cmath>

namespace PeriDeal
{
  namespace
  {
    /**
     * One linear system by conjugate gradients with multigrid, by GMRES where the forces have no
     * energy.
     */
    class LinearStatics : public StaticSolver
    {
    public:
      LinearStatics(ElasticOperator &op, const StaticOptions &options)
        : op(op)
        , solver(op, options.tolerance, options.max_iterations, options.direct_up_to)
        , most_iterations(options.max_iterations)
      {
        AssertThrow(
          !op.nonlinear(),
          UserError(
            "'Solver = linear' in section 'Elasticity' needs 'Kinematics = linear'; use 'conjugate gradients'."));
        op.initialize_vector(residual);
        op.initialize_vector(change);
      }

      std::string name() const override
      {
        return "linear";
      }

      void operator_changed() override
      {
        solver.operator_changed();
        is_untried = false;
      }

      void stiffness_changed() override
      {
        solver.operator_changed();
      }

      void exchange(Archive &archive) override
      {
        solver.exchange(archive);
        archive.exchange("untried", is_untried);
      }

      unsigned int solve(Vector &u, const double t, const double size) override
      {
        op.distribute(u, t);
        op.residual(residual, u, t);
        if (is_untried && residual.l2_norm() > 0.)
          {
            check_no_loose_part(op, solver.surrogate(), residual);
            is_untried = false;
          }
        change                    = 0.;
        const double scale        = size > 0. ? size : residual.l2_norm();
        unsigned int n_iterations = most_iterations;
        try
          {
            n_iterations = solver.solve(0., 1., change, residual, size);
            u += change;
          }
        catch (const Diverged &failure)
          {
            u += change; // the last iterate
            if (failure.trip.monitor != "solver" || !is_round_off(u, t, scale))
              throw;
            accept_residual(residual.l2_norm() / scale);
          }
        AssertThrow(
          std::isfinite(u.l1_norm()),
          UserError(
            "The displacement is not finite. Check the material, the boundary values and whether every part of the body is held."));
        return n_iterations;
      }

    private:
      bool is_round_off(const Vector &u, const double t, const double scale)
      {
        op.residual(residual, u, t);
        return residual.l2_norm() <= round_off_of_forces(op, u, scale);
      }

      ElasticOperator   &op;
      LinearSolver       solver;
      const unsigned int most_iterations;
      Vector             residual, change;
      bool               is_untried = true; // later on fragments may come loose
    };
  } // namespace


  std::unique_ptr<StaticSolver> make_linear_statics(ElasticOperator     &op,
                                                    const StaticOptions &options)
  {
    return std::make_unique<LinearStatics>(op, options);
  }
} // namespace PeriDeal
