// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/numbers.h>

#include <perideal/base/node_loops.h>
#include <perideal/base/progress.h>
#include <perideal/base/step_break.h>
#include <perideal/base/user_error.h>
#include <perideal/solvers/heat_steps.h>
#include <perideal/solvers/step_tools.h>
#include <perideal/solvers/stepper.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace PeriDeal
{
  namespace
  {
    /** phi_1(z) = (exp(z) - 1) / z for z <= 0. */
    double phi1(const double z)
    {
      return z == 0. ? 1. : std::expm1(z) / z;
    }


    /**
     * Chebyshev coefficients of x -> phi_1(z (x - 1) / 2) on [-1, 1], cut where the sum of the rest
     * is below the tolerance. The degree grows like sqrt(z log(1/tolerance)).
     */
    std::vector<double> expansion(const double z, const double tolerance)
    {
      const double       digits = std::log(1. / tolerance) + 3.;
      const unsigned int n =
        static_cast<unsigned int>(std::ceil(1.5 * std::sqrt(z * digits) + 1.5 * digits)) + 8;
      std::vector<double> coefficients(n, 0.), before(n), last(n), x(n), value(n);
      for (unsigned int i = 0; i < n; ++i)
        {
          x[i]      = std::cos(dealii::numbers::PI * (i + 0.5) / n);
          value[i]  = phi1(0.5 * z * (x[i] - 1.)) * 2. / n;
          before[i] = 1.;
          last[i]   = x[i];
        }
      for (unsigned int k = 0; k < n; ++k)
        for (unsigned int i = 0; i < n; ++i)
          {
            coefficients[k] += value[i] * before[i] * (k == 0 ? 0.5 : 1.);
            const double next = 2. * x[i] * last[i] - before[i];
            before[i]         = last[i];
            last[i]           = next;
          }
      double rest = 0.;
      while (coefficients.size() > 2 && rest + std::abs(coefficients.back()) < tolerance)
        {
          rest += std::abs(coefficients.back());
          coefficients.pop_back();
        }
      return coefficients;
    }


    /**
     * Chebyshev coefficients of phi_2 = (phi_1 - 1)/z at z (x - 1) / 2 from those of phi_1, one
     * less: the coefficients of both sides of (z/2)(x - 1) phi_2 = phi_1 - 1, from the highest one
     * downwards.
     */
    std::vector<double> next_expansion(const std::vector<double> &of_phi1, const double z)
    {
      const std::size_t   n = of_phi1.size();
      std::vector<double> coefficients(n + 1, 0.);
      for (std::size_t k = n - 1; k > 1; --k)
        coefficients[k - 1] = 2. * coefficients[k] - coefficients[k + 1] + 4. / z * of_phi1[k];
      coefficients[0] = coefficients[1] - 0.5 * coefficients[2] + 2. / z * of_phi1[1];
      coefficients.resize(n - 1);
      return coefficients;
    }


    /**
     * Exponential integrator for constant loads: u(t + tau) = u + tau phi_1(tau A) C^{-1} (f - K
     * u), A = -C^{-1} K, with phi_1 expanded in Chebyshev polynomials over the spectrum of A. Exact
     * in time up to the tolerance, for any tau; needs a symmetric K.
     */
    class Chebyshev : public Stepper
    {
    public:
      Chebyshev(DiffusionOperator &op, const StepperOptions &options)
        : op(op)
        , dt(options.time_step)
        , tolerance(0.1 * options.tolerance)
      {
        AssertThrow(
          op.symmetric(),
          UserError(
            "'Stepper = chebyshev' in section 'Time' needs a symmetric operator, and extrapolated fluxes or the "
            "papers' self term (section 'Peridynamics') make it nonsymmetric. Use rkc2 or auto."));
        AssertThrow(
          !op.depends_on_solution(),
          UserError(
            "'Stepper = chebyshev' in section 'Time' needs a material, sides and sources that do not depend on the temperature (T in "
            "section 'Material', 'Radiation'). Use rkc2, sdirk2 or auto."));
        AssertThrow(
          !op.depends_on_time(),
          UserError(
            "'Stepper = chebyshev' in section 'Time' needs loads and boundary values that do not change "
            "with time. Use rkc2 or auto."));
        for (Vector *v : {&last, &now, &image, &sum})
          op.initialize_vector(*v);
        inverse = inverse_capacity(op);
      }

      std::string name() const override
      {
        return "chebyshev";
      }

      bool steps_can_be_left() const override
      {
        return true;
      }

      double current_step() const override
      {
        return dt > 0. ? dt : 0.;
      }

      double expected_applications(const double time_span) const override
      {
        const auto n =
          static_cast<double>(dt > 0. ? n_equal_steps(time_span, dt) : n_expansions(time_span));
        return n * expected_size(spectral_bound() * time_span / n);
      }

      std::size_t memory_consumption() const override
      {
        return memory_of({&last, &now, &image, &sum}) + inverse.capacity() * sizeof(double);
      }

    private:
      void begin_span(const Vector &) override
      {
        const double length = span.end - span.start;
        span.n_steps        = dt > 0. ? n_equal_steps(length, dt) : n_expansions(length);
      }

      void take_step(Vector &u) override
      {
        const double tau = (span.end - span.start) / static_cast<double>(span.n_steps);
        step(u, span.start, tau);
        span.now = span.start + (span.n_done + 1) * tau;
        tell_step(span.now);
      }

      void end_span(Vector &u) override
      {
        op.distribute(u, span.end);
        check_finite(u, name(), span.end);
      }

      /** A little above the sharp bound: outside its interval a Chebyshev expansion grows. */
      double spectral_bound() const
      {
        const Spectrum spectrum = op.spectrum();
        return std::min(1.01 * spectrum.sharp, spectrum.safe);
      }


      /**
       * About the number of coefficients of one expansion. There may be a million spans of time
       * between events, most of them alike, so that few are found, and those only where that is
       * fast: beyond, the number grows like the root of z.
       */
      double expected_size(const double z) const
      {
        constexpr double longest = 1e4, resolution = 1e-3;
        const double     shorter = std::min(z, longest);
        const auto found = sizes.try_emplace(std::llround(std::log(shorter) / resolution), 0.);
        if (found.second)
          found.first->second = static_cast<double>(expansion(shorter, 1e-2 * tolerance).size());
        return found.first->second * std::sqrt(z / shorter);
      }


      /** Finding the coefficients takes the square of the degree: some 1e4 of them at once. */
      unsigned long long n_expansions(const double span) const
      {
        constexpr double longest = 1e7; // times the largest eigenvalue
        return n_equal_steps(span, longest / spectral_bound());
      }


      void step(Vector &u, const double t, const double tau)
      {
        ++spent.steps;
        compute_rate(op, u, t, last);
        heat_entered += tau * op.entering();
        const double change = tau * capacity_norm(op, last), level = capacity_norm(op, u);
        if (change == 0.)
          return;
        const double              bound = spectral_bound();
        const std::vector<double> coefficients =
          expansion(bound * tau, std::clamp(tolerance * level / change, 1e-17, 0.1));
        const std::vector<double> of_heat = next_expansion(coefficients, bound * tau);
        // The argument B = 1 + 2 A / bound of the polynomials has its spectrum in [-1, 1]: T_0 v =
        // last, T_1 v = now.
        const double scale = 2. / bound;
        op.apply_then(image, last, [&](const unsigned int begin, const unsigned int end) {
          for (unsigned int i = begin; i < end; ++i)
            {
              now.local_element(i) =
                last.local_element(i) - scale * (image.local_element(i) * inverse[i]);
              sum.local_element(i) =
                coefficients[0] * last.local_element(i) + coefficients[1] * now.local_element(i);
            }
        });
        heat_entered += tau * tau * of_heat[0] * op.entering();
        for (std::size_t k = 2; k < coefficients.size(); ++k)
          {
            leave_step_if_asked(u.get_mpi_communicator());
            op.apply_then(image, now, [&](const unsigned int begin, const unsigned int end) {
              NodeLoops::chebyshev_term(last.begin() + begin,
                                        sum.begin() + begin,
                                        now.begin() + begin,
                                        inverse.data() + begin,
                                        image.begin() + begin,
                                        2. * scale,
                                        coefficients[k],
                                        end - begin);
            });
            heat_entered += tau * tau * of_heat[k - 1] * op.entering();
            last.swap(now);
          }
        u.add(tau, sum);
      }

      DiffusionOperator  &op;
      const double        dt, tolerance;
      Vector              last, now, image, sum;
      std::vector<double> inverse; // of the capacity

      mutable std::map<long long, double> sizes; // of expected_size(), by the logarithm of z
    };
  } // namespace


  std::unique_ptr<Stepper> make_chebyshev(DiffusionOperator &op, const StepperOptions &options)
  {
    return std::make_unique<Chebyshev>(op, options);
  }
} // namespace PeriDeal
