// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/solvers/static_solver.h>
#include <perideal/solvers/step_tools.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  namespace
  {
    /**
     * The motion of the body itself, from rest, with velocity Verlet and a viscosity parallel to
     * the bonds (Le 2014 eq 2.43; with finite elements proportional to the stiffness) until it has
     * come to rest. The viscosity gamma damps the slowest motion critically: with d the
     * displacement of the last steps, in which fast motions have died away, gamma = 2 sqrt(d.Kd
     * d.Md)/(d.Dd). The step keeps dt^2 omega^2 + 2 gamma dt D below 4, and grows as the square of
     * the spacing: steps go with (L/h)^2.
     */
    class DynamicRelaxation : public StaticSolver
    {
    public:
      DynamicRelaxation(ElasticOperator &op, const StaticOptions &options)
        : op(op)
        , options(options)
        , inverse_mass((require_mass(op), inverse_capacity(op)))
        , stiffest(op.spectrum().sharp)
        , most_damped(op.damping_bound())
      {
        for (Vector *v : {&velocity, &residual, &drag, &marked, &marked_residual})
          op.initialize_vector(*v);
      }

      std::string name() const override
      {
        return "dynamic relaxation";
      }

      unsigned int solve(Vector &u, const double t, const double size) override
      {
        constexpr unsigned int period = 50;
        ResidualGoal           goal(name(), options, size);
        RoundOffGoal           round_off(op, options, size);
        if (outdated)
          {
            stiffest    = op.spectrum().sharp;
            most_damped = op.damping_bound();
            outdated    = false;
          }
        op.distribute(u, t);
        op.linearize(u);
        op.residual(residual, u, t);
        velocity        = 0.;
        viscosity       = 0.;
        marked          = u;
        marked_residual = residual;
        choose_step();
        unsigned int n = 0;
        for (; !round_off.reached(residual, u, n) && !goal.reached(residual, n); ++n)
          {
            if (n % period == period - 1)
              adapt(u);
            if (viscosity > 0.)
              {
                op.damping_force(drag, velocity);
                residual.add(-viscosity, drag);
              }
            for (unsigned int i = 0; i < inverse_mass.size(); ++i)
              velocity.local_element(i) += dt * inverse_mass[i] * residual.local_element(i);
            u.add(dt, velocity);
            op.residual(residual, u, t);
          }
        return n;
      }

      void operator_changed() override
      {
        outdated = outdated || op.has_growing_cracks(); // what only breaks gets no stiffer
      }

      void stiffness_changed() override
      {
        outdated = true;
      }

    private:
      void adapt(const Vector &u)
      {
        marked.sadd(-1., 1., u);
        marked_residual -= residual;
        op.linearize(u);
        op.damping_force(drag, marked);
        double mass = 0.;
        for (unsigned int i = 0; i < inverse_mass.size(); ++i)
          mass += marked.local_element(i) * marked.local_element(i) / inverse_mass[i];
        mass                   = dealii::Utilities::MPI::sum(mass, u.get_mpi_communicator());
        const double stiffness = marked * marked_residual, damping = marked * drag;
        if (stiffness > 0. && damping > 0.)
          viscosity = 2. * std::sqrt(stiffness * mass) / damping;
        choose_step();
        marked          = u;
        marked_residual = residual;
      }

      void choose_step()
      {
        constexpr double share = 0.9; // of the stable step
        const double     drop  = viscosity * most_damped;
        dt                     = share * 4. / (drop + std::sqrt(drop * drop + 4. * stiffest));
      }

      ElasticOperator          &op;
      const StaticOptions       options;
      const std::vector<double> inverse_mass;
      double                    stiffest, most_damped;
      bool                      outdated  = false; // these two
      double                    viscosity = 0., dt = 0.;
      Vector                    velocity, residual, drag, marked, marked_residual;
    };
  } // namespace


  std::unique_ptr<StaticSolver> make_dynamic_relaxation(ElasticOperator     &op,
                                                        const StaticOptions &options)
  {
    return std::make_unique<DynamicRelaxation>(op, options);
  }
} // namespace PeriDeal
