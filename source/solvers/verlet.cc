// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/node_loops.h>
#include <perideal/solvers/motion_stepper.h>

namespace PeriDeal
{
  namespace
  {
    /**
     * Velocity Verlet: second order, explicit, one application a step, stable up to dt =
     * 2/omega_max.
     */
    class Verlet : public MotionStepper
    {
    public:
      Verlet(ElasticOperator &op, const double dt)
        : MotionStepper(op, dt, 0.125)
      {
        op.stepping.follow = true;
      }

      std::string name() const override
      {
        return "verlet";
      }

    protected:
      void step(Vector &u, Vector &v, const double t, const double dt) override
      {
        const std::size_t n = v.locally_owned_size();
        if (op.nonlinear())
          last_velocity = v;
        NodeLoops::kick_and_drift(v.begin(),
                                  u.begin(),
                                  last.begin(),
                                  free_inverse_mass.data(),
                                  unbalanced.begin(),
                                  0.5 * dt,
                                  dt,
                                  n);
        op.distribute(u, t + dt);
        find_touching(u);
        op.unbalanced(unbalanced, u, t + dt);
        NodeLoops::accumulate(v.begin(), free_inverse_mass.data(), unbalanced.begin(), 0.5 * dt, n);
        follow_supports(v, u, dt);
      }
    };
  } // namespace


  std::unique_ptr<MotionStepper> make_verlet(ElasticOperator &op, const StepperOptions &options)
  {
    return std::make_unique<Verlet>(op, options.time_step);
  }
} // namespace PeriDeal
