// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

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
        op.initialize_vector(acceleration);
        op.forgoes_diagonal = true;
      }

      std::string name() const override
      {
        return "verlet";
      }

    protected:
      void step(Vector &u, Vector &v, const double t, const double dt) override
      {
        accelerate(acceleration, unbalanced);
        v.add(0.5 * dt, acceleration);
        u.add(dt, v);
        op.distribute(u, t + dt);
        op.unbalanced(unbalanced, u, t + dt);
        accelerate(acceleration, unbalanced);
        v.add(0.5 * dt, acceleration);
        follow_supports(v, u, dt);
      }

    private:
      Vector acceleration;
    };
  } // namespace


  std::unique_ptr<MotionStepper> make_verlet(ElasticOperator &op, const StepperOptions &options)
  {
    return std::make_unique<Verlet>(op, options.time_step);
  }
} // namespace PeriDeal
