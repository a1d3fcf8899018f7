// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/solvers/static_solver.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  namespace
  {
    /**
     * Adaptive dynamic relaxation (Underwood 1983, Kilic and Madenci 2010): a motion with a
     * fictitious diagonal mass Lambda and damping c Lambda, central differences and a step of one.
     * Lambda = kappa/4 diag K makes that step stable, kappa (with a margin) the largest eigenvalue
     * of diag(K)^-1 K; c = 2 omega damps critically what moves: omega^2 = v.Kv/v.Lambda v, the
     * Rayleigh quotient of the last step, K v from the residuals before and after. (The published
     * quotient, of u and a diagonal local stiffness, takes more iterations.) Iterations go with
     * L/h.
     *
     * A deformed body may be stiffer than kappa, which is that of the body at rest, allows: then a
     * motion that turns round at each step comes up, whose quotient is 4 or more, and Lambda is
     * raised.
     */
    class AdaptiveDynamicRelaxation : public StaticSolver
    {
    public:
      AdaptiveDynamicRelaxation(ElasticOperator &op, const StaticOptions &options)
        : op(op)
        , options(options)
      {
        for (Vector *v : {&mass, &velocity, &residual, &last})
          op.initialize_vector(*v);
        find_mass();
      }

      std::string name() const override
      {
        return "adaptive dynamic relaxation";
      }

      unsigned int solve(Vector &u, const double t, const double size) override
      {
        ResidualGoal goal(name(), options, size);
        RoundOffGoal round_off(op, options, size);
        if (outdated)
          find_mass();
        op.distribute(u, t);
        op.residual(residual, u, t);
        velocity       = 0.;
        unsigned int n = 0;
        for (; !round_off.reached(residual, u, n) && !goal.reached(residual, n); ++n)
          {
            const double       damping = n == 0 ? 0. : adapt(u);
            const double       keep    = (2. - damping) / (2. + damping);
            const double       push    = n == 0 ? 0.5 : 2. / (2. + damping);
            const unsigned int n_own   = mass.locally_owned_size();
            for (unsigned int i = 0; i < n_own; ++i)
              velocity.local_element(i) = keep * velocity.local_element(i) +
                                          push * residual.local_element(i) / mass.local_element(i);
            u += velocity;
            last.swap(residual);
            op.residual(residual, u, t);
          }
        return n;
      }

      void operator_changed() override
      {
        outdated = true; // where faces touch, stiffer
      }

    private:
      void find_mass()
      {
        constexpr double margin = 1.1;
        mass                    = op.diagonal();
        mass *= 0.25 * margin * op.scaled_bound();
        outdated = false;
      }

      /** The damping from the last step; raises the mass where that step was not stable. */
      double adapt(const Vector &u)
      {
        constexpr double   most   = 1.9; // below 2: velocities must not turn round
        constexpr double   stable = 4., nearly = 0.93, margin = 1.2, at_once = 2.;
        double             sum[2] = {0., 0.};
        const unsigned int n      = mass.locally_owned_size();
        for (unsigned int i = 0; i < n; ++i)
          {
            const double v = velocity.local_element(i);
            sum[0] += v * (last.local_element(i) - residual.local_element(i));
            sum[1] += v * v * mass.local_element(i);
          }
        for (double &s : sum)
          s = dealii::Utilities::MPI::sum(s, u.get_mpi_communicator());
        if (op.nonlinear() && sum[0] > nearly * stable * sum[1])
          mass *= std::min(margin * sum[0] / (stable * sum[1]), at_once);
        return sum[0] > 0. ? std::min(2. * std::sqrt(sum[0] / sum[1]), most) : 0.;
      }

      ElasticOperator    &op;
      const StaticOptions options;
      Vector              mass, velocity, residual, last;
      bool                outdated = false; // the mass
    };
  } // namespace


  std::unique_ptr<StaticSolver> make_adaptive_dynamic_relaxation(ElasticOperator     &op,
                                                                 const StaticOptions &options)
  {
    return std::make_unique<AdaptiveDynamicRelaxation>(op, options);
  }
} // namespace PeriDeal
