// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/numbers.h>

#include <perideal/base/node_loops.h>
#include <perideal/base/user_error.h>
#include <perideal/solvers/step_tools.h>
#include <perideal/solvers/stepper.h>

#include <algorithm>
#include <cmath>

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
     * Chebyshev coefficients of x -> phi_1(z (x - 1) / 2) on [-1, 1], cut where the sum of the rest is below the tolerance. The degree
     * grows like sqrt(z log(1/tolerance)).
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
     * Exponential integrator for constant loads: u(t + tau) = u + tau phi_1(tau A) C^{-1} (f - K u), A = -C^{-1} K, with phi_1 expanded in Chebyshev
     * polynomials over the spectrum of A. Exact in time up to the tolerance, for any tau; needs a symmetric K.
     */
    class Chebyshev : public Stepper
    {
    public:
      Chebyshev(Operator &op, const StepperOptions &options)
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
            "'Stepper = chebyshev' in section 'Time' needs a material that does not depend on the temperature (T in "
            "section 'Material'). Use rkc2, sdirk2 or auto."));
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

      void advance(Vector &u, const double t, const double t_end) override
      {
        const unsigned long long n = dt > 0. ? n_equal_steps(t_end - t, dt) :
                                               n_expansions(t_end - t);
        for (unsigned long long k = 0; k < n; ++k)
          step(u, t, (t_end - t) / static_cast<double>(n));
        op.distribute(u, t_end);
        check_finite(u, name(), t_end);
      }

      double current_step() const override
      {
        return dt > 0. ? dt : 0.;
      }

      double expected_applications(const double time_span) const override
      {
        const auto n =
          static_cast<double>(dt > 0. ? n_equal_steps(time_span, dt) : n_expansions(time_span));
        return n * static_cast<double>(
                     expansion(spectral_bound() * time_span / n, 1e-2 * tolerance).size());
      }

      std::size_t memory_consumption() const override
      {
        return memory_of({&last, &now, &image, &sum}) + inverse.capacity() * sizeof(double);
      }

    private:
      /** A little above the sharp bound: outside its interval a Chebyshev expansion grows. */
      double spectral_bound() const
      {
        const Spectrum spectrum = op.spectrum();
        return std::min(1.01 * spectrum.sharp, spectrum.safe);
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
        const double change = tau * capacity_norm(op, last), level = capacity_norm(op, u);
        if (change == 0.)
          return;
        const double              bound = spectral_bound();
        const std::vector<double> coefficients =
          expansion(bound * tau, std::clamp(tolerance * level / change, 1e-17, 0.1));
        // The argument B = 1 + 2 A / bound of the polynomials has its spectrum in [-1, 1]: T_0 v = last, T_1 v = now.
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
        for (std::size_t k = 2; k < coefficients.size(); ++k)
          {
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
            last.swap(now);
          }
        u.add(tau, sum);
      }

      Operator           &op;
      const double        dt, tolerance;
      Vector              last, now, image, sum;
      std::vector<double> inverse; // of the capacity
    };
  } // namespace


  std::unique_ptr<Stepper> make_chebyshev(Operator &op, const StepperOptions &options)
  {
    return std::make_unique<Chebyshev>(op, options);
  }
} // namespace PeriDeal
