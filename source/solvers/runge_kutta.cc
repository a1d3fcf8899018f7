// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/node_loops.h>
#include <perideal/base/progress.h>
#include <perideal/solvers/heat_steps.h>
#include <perideal/solvers/step_tools.h>
#include <perideal/solvers/stepper.h>

#include <algorithm>

namespace PeriDeal
{
  namespace
  {
    constexpr unsigned int steps_between_checks = 100;


    /**
     * Steps of one size; the last one of a span is shorter if it has to land. `auto` takes a share
     * of the stable step.
     */
    class FixedStepper : public Stepper
    {
    public:
      FixedStepper(DiffusionOperator    &op,
                   const StepperOptions &options,
                   const std::string    &method,
                   const double          share_of_bound)
        : op(op)
        , method(method)
        , fixed(options.time_step > 0.)
        , share_of_bound(share_of_bound)
        , dt(fixed ? options.time_step : share_of_bound * stable_step(method, op.spectrum().sharp))
        , conservative(op)
        , held(op)
        , inverse(inverse_capacity(op))
      {
        if (conservative.needed())
          op.initialize_vector(old);
      }

      std::string name() const override
      {
        return method;
      }

      void restart() override
      {
        if (!fixed)
          dt = share_of_bound * stable_step(method, op.spectrum().sharp);
        else if (!found.has("time step"))
          try
            {
              refuse_unstable_step(method, op, dt);
            }
          catch (Diverged &diverged)
            {
              diverged.trip.time = span.now;
              found.add(diverged, spent.steps);
            }
      }

      double current_step() const override
      {
        return dt;
      }

    protected:
      void begin_span(const Vector &u) override
      {
        if (op.depends_on_solution())
          return;
        held.begin(u);
        span.n_steps = n_equal_steps(span.end - span.start, dt);
      }

      void take_step(Vector &u) override
      {
        if (op.depends_on_solution())
          {
            take_lagged_step(u);
            return;
          }
        const double now  = span.start + static_cast<double>(span.n_done) * dt;
        const double size = (span.n_done + 1 == span.n_steps) ? span.end - now : dt;
        step(u, now, size);
        span.now = now + size;
        ++spent.steps;
        tell_step(span.now);
        if (spent.steps % steps_between_checks == 0)
          check_finite(u, method, span.now);
      }

      /** The material is that of the temperatures at the beginning of the step. */
      void take_lagged_step(Vector &u)
      {
        const double t = span.now;
        op.distribute(u, t);
        op.take_material_at(u, t);
        inverse = inverse_capacity(op);
        restart(); // the bound of this step
        const bool   lands = t + dt * (1. + 1e-10) >= span.end;
        const double size  = lands ? span.end - t : dt;
        if (conservative.needed())
          old = u;
        else
          held.begin(u);
        step(u, t, size);
        span.now = lands ? span.end : t + dt;
        op.distribute(u, span.now);
        heat_entered += conservative.needed() ? conservative.correct(old, u) : held.taken(u);
        ++spent.steps;
        tell_step(span.now);
        check_finite(u, method, span.now);
      }

      void end_span(Vector &u) override
      {
        op.distribute(u, span.end);
        if (op.depends_on_solution())
          {
            op.take_material_at(u, span.end); // for what is written there
            return;
          }
        check_finite(u, method, span.end);
        heat_entered += held.taken(u);
      }

      void exchange_own(Archive &archive, const NodeKeys &keys) override
      {
        archive.exchange("time step", dt);
        held.exchange(archive, keys);
      }

      virtual void step(Vector &u, const double t, const double size) = 0;

      DiffusionOperator &op;

    private:
      const std::string method;
      const bool        fixed;
      const double      share_of_bound;
      double            dt;
      ConservativeStep  conservative;
      HeldHeat          held;
      Vector            old;

    protected:
      std::vector<double> inverse; // of the capacity
    };


    /** Forward Euler. */
    class Euler : public FixedStepper
    {
    public:
      Euler(DiffusionOperator &op, const StepperOptions &options)
        : FixedStepper(op, options, "euler", 0.9)
      {
        op.initialize_vector(next);
      }

      std::size_t memory_consumption() const override
      {
        return memory_of({&next}) + inverse.capacity() * sizeof(double);
      }

      double expected_applications(const double time_span) const override
      {
        return static_cast<double>(n_equal_steps(time_span, current_step()));
      }

    private:
      void step(Vector &u, const double t, const double size) override
      {
        op.distribute(u, t);
        op.residual_then(next, u, t, [&](const unsigned int begin, const unsigned int end) {
          double *values = next.begin(), *now = u.begin();
          for (unsigned int i = begin; i < end; ++i)
            values[i] = now[i] + size * (inverse[i] * values[i]);
        });
        heat_entered += size * op.entering();
        u.swap(next);
      }

      Vector next;
    };


    /** The classical fourth order Runge-Kutta method. */
    class RK4 : public FixedStepper
    {
    public:
      RK4(DiffusionOperator &op, const StepperOptions &options)
        : FixedStepper(op, options, "rk4", 0.95)
      {
        for (Vector *v : {&rate, &stage, &next_stage, &sum})
          op.initialize_vector(*v);
      }

      std::size_t memory_consumption() const override
      {
        return memory_of({&rate, &stage, &next_stage, &sum}) + inverse.capacity() * sizeof(double);
      }

      double expected_applications(const double time_span) const override
      {
        return 4. * static_cast<double>(n_equal_steps(time_span, current_step()));
      }

    private:
      void step(Vector &u, const double t, const double size) override
      {
        constexpr double place[4]  = {0., 0.5, 0.5, 1.},
                         weight[4] = {1. / 6., 1. / 3., 1. / 3., 1. / 6.};
        for (unsigned int s = 0; s < 4; ++s)
          {
            Vector      &at   = s == 0 ? u : stage;
            const double here = t + place[s] * size;
            op.distribute(at, here);
            op.residual_then(rate, at, here, [&](const unsigned int begin, const unsigned int end) {
              const std::size_t n = end - begin;
              // sum becomes u plus the weighted rates so far.
              if (s == 0)
                NodeLoops::advance(sum.begin() + begin,
                                   u.begin() + begin,
                                   inverse.data() + begin,
                                   rate.begin() + begin,
                                   weight[s] * size,
                                   n);
              else
                NodeLoops::accumulate(sum.begin() + begin,
                                      inverse.data() + begin,
                                      rate.begin() + begin,
                                      weight[s] * size,
                                      n);
              if (s < 3)
                NodeLoops::advance(next_stage.begin() + begin,
                                   u.begin() + begin,
                                   inverse.data() + begin,
                                   rate.begin() + begin,
                                   place[s + 1] * size,
                                   n);
            });
            heat_entered += weight[s] * size * op.entering();
            stage.swap(next_stage);
          }
        u.swap(sum);
      }

      Vector rate, stage, next_stage, sum;
    };
  } // namespace


  std::unique_ptr<Stepper> make_euler(DiffusionOperator &op, const StepperOptions &options)
  {
    return std::make_unique<Euler>(op, options);
  }


  std::unique_ptr<Stepper> make_rk4(DiffusionOperator &op, const StepperOptions &options)
  {
    return std::make_unique<RK4>(op, options);
  }
} // namespace PeriDeal
