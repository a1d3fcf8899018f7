// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/diverged.h>
#include <perideal/base/user_error.h>
#include <perideal/solvers/floating_part.h>
#include <perideal/solvers/linear_solver.h>
#include <perideal/solvers/round_off.h>
#include <perideal/solvers/static_solver.h>

#include <cmath>
#include <memory>

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
        , options(options)
      {
        AssertThrow(
          !op.nonlinear(),
          UserError(
            "'Solver = linear' in section 'Elasticity' needs 'Kinematics = linear'; use 'conjugate gradients'."));
        make_solver();
        op.initialize_vector(residual);
        op.initialize_vector(change);
      }

      std::string name() const override
      {
        return "linear";
      }

      void operator_changed() override
      {
        if (op.may_release_energy())
          solver->operator_changed();
        contact.changes = true;
        is_untried      = false;
      }

      void exchange(Archive &archive) override
      {
        solver->exchange(archive);
        archive.exchange("contact changes", contact.changes);
        archive.exchange("contact is known", contact.is_known);
        archive.exchange("first rate", contact.first_rate);
        archive.exchange("last rate", contact.last_rate);
        archive.exchange("untried", is_untried);
      }

      unsigned int solve(Vector &u, const double t, const double size) override
      {
        op.distribute(u, t);
        op.residual(residual, u, t);
        if (is_untried && residual.l2_norm() > 0.)
          {
            check_no_loose_part(op, solver->surrogate(), residual);
            is_untried = false;
          }
        follow_contact();
        change                    = 0.;
        const double start        = residual.l2_norm();
        const double scale        = size > 0. ? size : start;
        unsigned int n_iterations = options.max_iterations;
        try
          {
            n_iterations = solver->solve(0., 1., change, residual, size);
            u += change;
            contact.changes = false;
            if (const double digits = std::log10(start / (options.tolerance * scale)); digits > 0.)
              contact.last_rate = n_iterations / digits;
            if (contact.first_rate == 0.)
              contact.first_rate = contact.last_rate;
          }
        catch (const Diverged &failure)
          {
            u += change; // the last iterate
            if (failure.trip.monitor != "solver" || !is_round_off(u, t))
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
      bool is_round_off(const Vector &u, const double t)
      {
        op.residual(residual, u, t);
        return residual.l2_norm() <= round_off_of_forces(op, u);
      }

      /** Where no bonds break only contact of faces changes what is solved. */
      void follow_contact()
      {
        constexpr double slower = 1.5;
        if (op.may_release_energy() || !contact.changes ||
            (contact.is_known && !(contact.last_rate > slower * contact.first_rate)))
          return;
        make_solver();
        contact.is_known   = true;
        contact.first_rate = 0.;
      }

      void make_solver()
      {
        solver = std::make_unique<LinearSolver>(op,
                                                options.tolerance,
                                                options.max_iterations,
                                                options.direct_up_to);
      }

      /** Of the preconditioner: faces that touch are as stiff as the body, but change. */
      struct Contact
      {
        bool   changes = false, is_known = false;
        double first_rate = 0., last_rate = 0.; // iterations for a digit since it was made
      };

      ElasticOperator              &op;
      const StaticOptions           options;
      std::unique_ptr<LinearSolver> solver;
      Contact                       contact;
      Vector                        residual, change;
      bool                          is_untried = true; // later on fragments may come loose
    };
  } // namespace


  std::unique_ptr<StaticSolver> make_linear_statics(ElasticOperator     &op,
                                                    const StaticOptions &options)
  {
    return std::make_unique<LinearStatics>(op, options);
  }
} // namespace PeriDeal
