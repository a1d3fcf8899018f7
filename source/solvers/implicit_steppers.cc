// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <algorithm>
#include <cmath>
#include <memory>

#include "implicit_stepper.h"

namespace PeriDeal
{
  namespace
  {
    /** Two implicit stages with the same matrix, L-stable, embedded first order solution. */
    class SDIRK2 : public ImplicitStepper
    {
    public:
      SDIRK2(DiffusionOperator &op, const StepperOptions &options)
        : ImplicitStepper(op, options, "sdirk2")
      {
        for (Vector *v : {&k1, &k2, &rate_before})
          op.initialize_vector(*v);
      }

      void restart() override
      {
        ImplicitStepper::restart();
        knows_rate = false;
      }

    private:
      /**
       * What changes at once before the first stage is in both rates, but not in the one at the end
       * of the step before: the larger difference counts. Of what is smooth that is the one of k2.
       */
      int step(const Vector &u, const double t, const double h) override
      {
        sdirk2(u, t, h, k1, k2);
        const double gamma      = 1. - std::sqrt(0.5);
        const auto   difference = [&](const Vector &a, const Vector &b) {
          for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
            error.local_element(i) = gamma * h * (a.local_element(i) - b.local_element(i));
          op.clear_constrained(error);
        };
        double before = 0.;
        if (knows_rate)
          {
            difference(k1, rate_before);
            before = capacity_norm(op, error);
          }
        difference(k2, k1);
        if (before > capacity_norm(op, error))
          difference(k1, rate_before);
        return 2;
      }

      void accept(const Vector &, const double) override
      {
        rate_before = k2;
        knows_rate  = true;
      }

      void exchange_own(Archive &archive, const NodeKeys &keys) override
      {
        ImplicitStepper::exchange_own(archive, keys);
        archive.exchange("rate before", rate_before, keys);
        archive.exchange("knows rate", knows_rate);
      }

      Vector k1, k2, rate_before; // rate_before: at the end of the last step
      bool   knows_rate = false;
    };


    /**
     * Two-step methods that start with SDIRK2. The local error is estimated from the difference to
     * an explicit predictor through the last three values.
     */
    class TwoStep : public ImplicitStepper
    {
    public:
      TwoStep(DiffusionOperator &op, const StepperOptions &options, const std::string &method)
        : ImplicitStepper(op, options, method)
      {
        for (Vector *v : {&previous, &oldest, &k1, &k2})
          op.initialize_vector(*v);
      }

      void restart() override
      {
        ImplicitStepper::restart();
        n_known = 0;
      }

    protected:
      int step(const Vector &u, const double t, const double h) override
      {
        // Fixed steps may grow at once: after a span whose steps were shorter, or divided.
        if (n_known < 1 || (fixed && h > (1. + std::sqrt(2.)) * h_previous))
          {
            sdirk2(u, t, h, k1, k2);
            const double gamma = 1. - std::sqrt(0.5);
            for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
              error.local_element(i) = gamma * h * (k2.local_element(i) - k1.local_element(i));
            return 2;
          }
        method_step(u, t, h);
        if (n_known < 2)
          return 0;
        for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
          error.local_element(i) = error_factor(h) * (next.local_element(i) - predicted(i, u, h));
        return 3;
      }

      void accept(const Vector &u, const double h) override
      {
        heat_before = step_heat;
        oldest.swap(previous);
        previous   = u;
        h_oldest   = h_previous;
        h_previous = h;
        n_known    = std::min(n_known + 1, 2ULL);
      }

      void exchange_own(Archive &archive, const NodeKeys &keys) override
      {
        ImplicitStepper::exchange_own(archive, keys);
        archive.exchange("previous", previous, keys);
        archive.exchange("oldest", oldest, keys);
        archive.exchange("previous step", h_previous);
        archive.exchange("oldest step", h_oldest);
        archive.exchange_share("heat before", heat_before);
        archive.exchange("known values", n_known);
      }

      virtual void   method_step(const Vector &u, const double t, const double h) = 0;
      virtual double error_factor(const double h) const                           = 0;

      /** Value at t + h of the parabola through the three last values. */
      double predicted(const unsigned int i, const Vector &u, const double h) const
      {
        const double a = -h_previous, b = -h_previous - h_oldest;
        const double l0 = (h - a) * (h - b) / (a * b), la = h * (h - b) / (a * (a - b)),
                     lb = h * (h - a) / (b * (b - a));
        return l0 * u.local_element(i) + la * previous.local_element(i) +
               lb * oldest.local_element(i);
      }

      Vector previous, oldest, k1, k2;
      double h_previous = 0., h_oldest = 0., heat_before = 0.;

      unsigned long long n_known = 0;
    };


    class BDF2 : public TwoStep
    {
    public:
      BDF2(DiffusionOperator &op, const StepperOptions &options)
        : TwoStep(op, options, "bdf2")
      {}

    private:
      void method_step(const Vector &u, const double t, const double h) override
      {
        const double w = h / h_previous, a0 = (1. + 2. * w) / (1. + w), a1 = 1. + w,
                     a2 = w * w / (1. + w);
        for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
          base.local_element(i) = (a1 * u.local_element(i) - a2 * previous.local_element(i)) / a0;
        next = u;
        if (op.capacity_depends_on_solution())
          known.equ(a2 / a0, taken);
        step_heat = a2 / a0 * heat_before + h / a0 * solve_stage(u, base, h / a0, t + h, next);
      }

      double error_factor(const double) const override
      {
        return 2. / 11.; // equal steps: error -2/9 h^3 u''', predictor h^3 u'''
      }
    };


    /** The trapezoidal rule; it does not damp fast modes, so it starts with L-stable steps. */
    class CrankNicolson : public TwoStep
    {
    public:
      CrankNicolson(DiffusionOperator &op, const StepperOptions &options)
        : TwoStep(op, options, "crank nicolson")
        , solver_tolerance(options.solver_tolerance)
        , max_iterations(options.max_iterations)
      {
        op.initialize_vector(load);
        op.initialize_vector(start);
      }

      /** The fastest wave gets the factor (1 - z/2)/(1 + z/2), which is negative from z = 2 on. */
      double left_of_fast_waves() const override
      {
        const double z = this->largest_rate();
        return std::max(0., (0.5 * z - 1.) / (0.5 * z + 1.));
      }

    private:
      void method_step(const Vector &u, const double t, const double h) override
      {
        // C (U - u) = h/2 (F(u, t) + F(U, t + h)): as a stage from U = u, with the old half of the
        // rate in the start value.
        start = u;
        op.distribute(start, t);
        op.take_material_at(start, t);
        op.distribute(start, t);
        op.residual(load, start, t);
        const double entering = op.entering();
        known.equ(0.5 * h, load);
        if (op.capacity_is_diagonal())
          for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
            base.local_element(i) = u.local_element(i) + 0.5 * h * load.local_element(i) /
                                                           op.lumped_capacity().local_element(i);
        else
          {
            base = 0.;
            spent.iterations += capacity_solver().solve(1., 0., base, load);
            base.sadd(0.5 * h, 1., u);
          }
        next      = u;
        step_heat = 0.5 * h * (entering + solve_stage(u, base, 0.5 * h, t + h, next));
      }

      double error_factor(const double) const override
      {
        return 1. / 13.; // equal steps: error h^3 u'''/12 against the predictor's h^3 u'''
      }

      LinearSolver &capacity_solver()
      {
        if (!mass_solver)
          mass_solver = std::make_unique<LinearSolver>(op, solver_tolerance, max_iterations);
        return *mass_solver;
      }

      Vector                        load, start;
      const double                  solver_tolerance;
      const unsigned int            max_iterations;
      std::unique_ptr<LinearSolver> mass_solver;
    };
  } // namespace


  std::unique_ptr<Stepper> make_sdirk2(DiffusionOperator &op, const StepperOptions &options)
  {
    return std::make_unique<SDIRK2>(op, options);
  }

  std::unique_ptr<Stepper> make_bdf2(DiffusionOperator &op, const StepperOptions &options)
  {
    return std::make_unique<BDF2>(op, options);
  }

  std::unique_ptr<Stepper> make_crank_nicolson(DiffusionOperator &op, const StepperOptions &options)
  {
    return std::make_unique<CrankNicolson>(op, options);
  }
} // namespace PeriDeal
