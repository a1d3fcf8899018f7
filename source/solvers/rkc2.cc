// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/node_loops.h>
#include <perideal/base/progress.h>
#include <perideal/base/step_break.h>
#include <perideal/base/user_error.h>
#include <perideal/solvers/heat_steps.h>
#include <perideal/solvers/step_tools.h>
#include <perideal/solvers/stepper.h>

#include <algorithm>
#include <cmath>
#include <sstream>


namespace PeriDeal
{
  namespace
  {
    /**
     * Second order stabilised explicit Runge-Kutta-Chebyshev method with adaptive steps and as many
     * stages as they need.
     */
    class RKC2 : public Stepper
    {
    public:
      /** @param n_stages of every step; 0: as many as it needs */
      RKC2(DiffusionOperator &op, const StepperOptions &options, const unsigned int n_stages)
        : op(op)
        , given_stages(n_stages)
        , fixed(options.time_step > 0.)
        , dt(fixed ? options.time_step : 0.)
        , tolerance(local_tolerance(options.tolerance))
        , conservative(op)
        , held(op)
      {
        for (Vector *v : {&rate, &stage_rate, &before, &last, &now})
          op.initialize_vector(*v);
        inverse = inverse_capacity(op);
      }

      std::string name() const override
      {
        return "rkc2";
      }

      bool steps_can_be_left() const override
      {
        return true;
      }

      double current_step() const override
      {
        return dt;
      }

      double expected_applications(const double time_span) const override
      {
        if (fixed)
          return static_cast<double>(n_equal_steps(time_span, dt) * n_stages(dt));
        // Steps grow with the solution's age; a few dozen of them with sqrt(lambda t) stages in
        // all, times a measured factor.
        return 2.5 * std::sqrt(1.54 * time_span * op.spectrum().sharp) *
                 std::cbrt(1e-3 / tolerance) +
               20.;
      }

      /** |a_s + b_s T_s|, whose Chebyshev polynomial is at most 1 beyond what is resolved. */
      double left_of_fast_waves() const override
      {
        constexpr double resolved = 2.; // step times eigenvalue
        if (!fixed || dt * op.spectrum().sharp <= resolved)
          return 0.;
        const unsigned int    s = n_stages(dt);
        const RkcCoefficients k(s);
        return k.a[s] + k.b[s];
      }

      std::size_t memory_consumption() const override
      {
        return memory_of({&rate, &stage_rate, &before, &last, &now}) +
               conservative.memory_consumption() + inverse.capacity() * sizeof(double);
      }

    private:
      void begin_span(const Vector &u) override
      {
        held.begin(u);
        has_rate = false;
        if (fixed)
          span.n_steps = n_equal_steps(span.end - span.start, dt);
        else if (dt == 0.)
          dt = std::min(span.end - span.start, 0.5 / op.spectrum().sharp);
      }

      void take_step(Vector &u) override
      {
        if (fixed)
          take_fixed_step(u);
        else
          take_adaptive_step(u);
      }

      void end_span(Vector &u) override
      {
        if (fixed)
          op.distribute(u, span.end);
        check_finite(u, name(), span.end);
        heat_entered += held.taken(u);
        if (fixed)
          take_material_at(u, span.end); // for what is written there
      }

      void exchange_own(Archive &archive, const NodeKeys &keys) override
      {
        archive.exchange("time step", dt);
        held.exchange(archive, keys);
        if (archive.loads())
          has_rate = false; // it is found again from u, to the last bit
      }

      void take_material_at(Vector &v, const double t)
      {
        if (!op.depends_on_solution())
          return;
        op.distribute(v, t);
        op.take_material_at(v, t);
        inverse = inverse_capacity(op);
      }


      unsigned int n_stages(const double h) const
      {
        constexpr double margin = 1.02; // of the bound of the spectrum
        return given_stages > 0 ? given_stages : rkc2_stages(margin * h * op.spectrum().sharp);
      }


      /**
       * From u at t with its rate to `now` at t + h. Returns what enters meanwhile, which has the
       * rate @p entering at t: the same formulas with one more unknown, 0 at t.
       */
      double stages(const Vector &u, const double t, const double h, const double entering)
      {
        const unsigned int    s = n_stages(h), n = u.locally_owned_size();
        const RkcCoefficients k(s);
        for (unsigned int i = 0; i < n; ++i)
          {
            before.local_element(i) = u.local_element(i);
            last.local_element(i) = u.local_element(i) + k.b[1] * k.w1 * h * rate.local_element(i);
          }
        double heat_before = 0., heat_last = k.b[1] * k.w1 * h * entering;
        for (unsigned int j = 2; j <= s; ++j)
          {
            leave_step_if_asked(u.get_mpi_communicator());
            const double mu = 2. * k.b[j] * k.w0 / k.b[j - 1], nu = -k.b[j] / k.b[j - 2],
                         mu_rate = 2. * k.b[j] * k.w1 / k.b[j - 1] * h,
                         gamma = -k.a[j - 1] * mu_rate, own = 1. - mu - nu;
            const double factors[5] = {own, mu, nu, mu_rate, gamma};
            op.distribute(last, t + k.c[j - 1] * h);
            op.residual_then(stage_rate,
                             last,
                             t + k.c[j - 1] * h,
                             [&](const unsigned int begin, const unsigned int end) {
                               NodeLoops::rkc_stage(now.begin() + begin,
                                                    u.begin() + begin,
                                                    last.begin() + begin,
                                                    before.begin() + begin,
                                                    inverse.data() + begin,
                                                    stage_rate.begin() + begin,
                                                    rate.begin() + begin,
                                                    factors,
                                                    end - begin);
                             });
            const double heat_now =
              mu * heat_last + nu * heat_before + mu_rate * op.entering() + gamma * entering;
            heat_before = heat_last;
            heat_last   = heat_now;
            if (j < s)
              {
                before.swap(last);
                last.swap(now);
              }
          }
        op.distribute(now, t + h);
        return heat_last;
      }


      void take_fixed_step(Vector &u)
      {
        const double h = (span.end - span.start) / static_cast<double>(span.n_steps);
        const double t = span.start + span.n_done * h;
        take_material_at(u, t);
        compute_rate(op, u, t, rate);
        heat_entered += stages(u, t, h, op.entering());
        heat_entered += conservative.correct(u, now);
        u.swap(now);
        ++spent.steps;
        span.now = span.start + (span.n_done + 1) * h;
        tell_step(span.now);
      }


      void find_rate(Vector &u, const double t)
      {
        take_material_at(u, t);
        compute_rate(op, u, t, rate);
        entering = op.entering();
        has_rate = true;
      }


      void take_adaptive_step(Vector &u)
      {
        const double t = span.now, t_end = span.end;
        if (!has_rate)
          find_rate(u, t);
        const bool   lands = t + dt * (1. + 1e-10) >= t_end;
        const double h     = lands ? t_end - t : std::min(dt, 0.5 * (t_end - t) + 0.5 * dt);
        double       heat  = stages(u, t, h, entering);
        heat += conservative.correct(u, now);
        take_material_at(now, t + h); // so that the error estimate sees what changes in the step
        compute_rate(op, now, t + h, stage_rate);
        const double error = estimated_error(u, h);
        check_error(error, t);
        const double growth = std::clamp(0.8 / std::cbrt(std::max(error, 1e-12)), 0.1, 5.);
        if (error <= 1.)
          {
            span.now = lands ? t_end : t + h;
            u.swap(now);
            rate.swap(stage_rate);
            heat_entered += heat;
            entering = op.entering();
            ++spent.steps;
            tell_step(span.now);
            dt = lands ? std::max(dt, h * growth) : h * growth;
          }
        else
          {
            ++spent.rejected;
            take_material_at(u, t);
            dt = h * std::min(growth, 0.9);
          }
      }


      /**
       * Of the step of size h from u to `now`, as a multiple of what is allowed: the method's
       * equation 2.10 in the root mean square.
       */
      double estimated_error(const Vector &u, const double h)
      {
        for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
          before.local_element(i) = 0.8 * (u.local_element(i) - now.local_element(i)) +
                                    0.4 * h * (rate.local_element(i) + stage_rate.local_element(i));
        // Where a prescribed value moves the rate is unknown, but there is no error either.
        op.clear_constrained(before);
        constexpr double share = 0.01;
        const double     old   = capacity_norm(op, u);
        double           level = std::max(old, capacity_norm(op, now));
        // A body at 0, where a source begins within the step, maybe after the last stage: against
        // what that makes until the end.
        if (old == 0.)
          level = std::max(level, share * (span.end - span.now) * capacity_norm(op, stage_rate));
        return level == 0. ? 0. : capacity_norm(op, before) / (tolerance * level);
      }


      void check_error(const double error, const double t) const
      {
        if (std::isfinite(error))
          return;
        std::ostringstream message;
        message
          << "The run became unstable: stepper 'rkc2' produced values that are not finite near t = "
          << t
          << ". Check loads and boundary values in time, or choose 'Stepper = sdirk2' in section 'Time'.";
        throw not_finite(message.str(), t);
      }

      DiffusionOperator  &op;
      const unsigned int  given_stages;
      const bool          fixed;
      double              dt;
      const double        tolerance;
      Vector              rate, stage_rate, before, last, now;
      std::vector<double> inverse; // of the capacity
      ConservativeStep    conservative;
      HeldHeat            held;
      bool                has_rate = false; // adaptive steps: `rate` is that of u
      double              entering = 0.;    // with that rate
    };
  } // namespace


  std::unique_ptr<Stepper> make_rkc2(DiffusionOperator &op, const StepperOptions &options)
  {
    return std::make_unique<RKC2>(op, options, 0);
  }


  std::unique_ptr<Stepper> make_rkc2(DiffusionOperator    &op,
                                     const StepperOptions &options,
                                     const unsigned int    n_stages)
  {
    Assert(n_stages >= 2, dealii::ExcMessage("The method has two stages at least."));
    return std::make_unique<RKC2>(op, options, n_stages);
  }
} // namespace PeriDeal
