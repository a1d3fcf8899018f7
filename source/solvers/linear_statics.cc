// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

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
        change                          = 0.;
        const unsigned int n_iterations = solver.solve(0., 1., change, residual, size);
        u += change;
        AssertThrow(
          std::isfinite(u.l1_norm()),
          UserError(
            "The displacement is not finite. Check the material, the boundary values and whether every part of the body is held."));
        return n_iterations;
      }

    private:
      ElasticOperator &op;
      LinearSolver     solver;
      Vector           residual, change;
      bool             is_untried = true; // later on fragments may come loose
    };
  } // namespace


  std::unique_ptr<StaticSolver> make_linear_statics(ElasticOperator     &op,
                                                    const StaticOptions &options)
  {
    return std::make_unique<LinearStatics>(op, options);
  }
} // namespace PeriDeal
