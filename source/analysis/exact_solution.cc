// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/point.h>

#include <perideal/analysis/exact_solid.h>
#include <perideal/analysis/exact_solution.h>
#include <perideal/base/user_error.h>
#include <perideal/scene/expression.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "solution_text.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** A solution that depends on x alone. */
    class BarSolution : public ExactSolution
    {
    public:
      using Series = std::function<ValueAndSlope(double x, double t)>;

      /** @param series in units of the length in x and of its diffusion time. */
      BarSolution(const ExactSolutionContext &context, const Series &series)
        : dim(context.dim)
        , lower(context.lower[0])
        , length(context.upper[0] - context.lower[0])
        , rate(context.conductivity / context.storage / (length * length))
        , series(series)
      {}

      double value(const double *x, const double t, const unsigned int) const override
      {
        return series((x[0] - lower) / length, rate * t).value;
      }

      bool gradient(const double *x, const double t, const unsigned int, double *g) const override
      {
        std::fill(g, g + dim, 0.);
        g[0] = series((x[0] - lower) / length, rate * t).slope / length;
        return true;
      }

    private:
      const unsigned int dim;
      const double       lower, length, rate;
      const Series       series;
    };


    /**
     * Bobaru 2012, example 1: a rectangle at 40 whose sides are held at 0; a product of two slabs.
     */
    class CoolingPlate : public ExactSolution
    {
    public:
      explicit CoolingPlate(const ExactSolutionContext &context)
        : context(context)
      {
        AssertThrow(context.dim == 2,
                    UserError(solution_entry +
                              ": 'bobaru 2012 example 1' is two-dimensional, but 'Dimension' is " +
                              std::to_string(context.dim) + "."));
      }

      double value(const double *x, const double t, const unsigned int) const override
      {
        return 40. * along(0, x, t).value * along(1, x, t).value;
      }

      bool gradient(const double *x, const double t, const unsigned int, double *g) const override
      {
        const ValueAndSlope a = along(0, x, t), b = along(1, x, t);
        g[0] = 40. * a.slope * b.value;
        g[1] = 40. * a.value * b.slope;
        return true;
      }

    private:
      /** The slab's value and its slope per length in direction d. */
      ValueAndSlope along(const unsigned int d, const double *x, const double t) const
      {
        const double  length = context.upper[d] - context.lower[d];
        ValueAndSlope slab =
          HeatSeries::cooling_slab((x[d] - context.lower[d]) / length,
                                   context.conductivity / context.storage * t / (length * length));
        slab.slope /= length;
        return slab;
      }

      const ExactSolutionContext context;
    };


    /** A product of sines that decays at a given rate. */
    class Harmonic : public ExactSolution
    {
    public:
      Harmonic(const std::vector<double>   &lower,
               const std::array<double, 3> &wave_numbers,
               const unsigned int           dim,
               const double                 rate)
        : dim(dim)
        , lower(lower)
        , k(wave_numbers)
        , rate(rate)
      {}

      double value(const double *x, const double t, const unsigned int) const override
      {
        double product = std::exp(-rate * t);
        for (unsigned int d = 0; d < dim; ++d)
          product *= std::sin(k[d] * (x[d] - lower[d]));
        return product;
      }

      bool gradient(const double *x, const double t, const unsigned int, double *g) const override
      {
        for (unsigned int a = 0; a < dim; ++a)
          {
            g[a] = std::exp(-rate * t);
            for (unsigned int d = 0; d < dim; ++d)
              g[a] *= d == a ? k[d] * std::cos(k[d] * (x[d] - lower[d])) :
                               std::sin(k[d] * (x[d] - lower[d]));
          }
        return true;
      }

    private:
      const unsigned int          dim;
      const std::vector<double>   lower;
      const std::array<double, 3> k;
      const double                rate;
    };


    class ExpressionSolution : public ExactSolution
    {
    public:
      ExpressionSolution(const std::string &text, const unsigned int dim)
        : dim(dim)
        , expression(text, solution_entry)
      {}

      double value(const double *x, const double t, const unsigned int) const override
      {
        Point<3> p;
        for (unsigned int d = 0; d < dim; ++d)
          p[d] = x[d];
        return expression.value<3>(p, t);
      }

      bool gradient(const double *, const double, const unsigned int, double *) const override
      {
        return false;
      }

    private:
      const unsigned int dim;
      const Expression   expression;
    };


    std::array<double, 3> wave_numbers(const SolutionCall         &call,
                                       const ExactSolutionContext &context)
    {
      const std::string wrong =
        solution_entry + ": '" + call.name + "' needs " + std::to_string(context.dim) +
        " positive whole number" + (context.dim == 1 ? "" : "s") +
        ", one per dimension, for example '" + call.name + "(1" + (context.dim > 1 ? ", 1" : "") +
        (context.dim > 2 ? ", 1" : "") + ")', but found '" + call.arguments + "'.";
      std::array<double, 3> k{{0., 0., 0.}};
      std::size_t           start = 0;
      for (unsigned int d = 0; d < context.dim; ++d)
        {
          const bool        last = d + 1 == context.dim;
          const std::size_t end  = call.arguments.find(',', start);
          AssertThrow((end == std::string::npos) == last && start <= call.arguments.size(),
                      UserError(wrong));
          const std::string number = tidy(call.arguments.substr(start, end - start));
          AssertThrow(!number.empty() && number.size() < 8 &&
                        number.find_first_not_of("0123456789") == std::string::npos &&
                        std::stoi(number) > 0,
                      UserError(wrong));
          k[d]  = std::stoi(number) * std::acos(-1.) / (context.upper[d] - context.lower[d]);
          start = end + 1;
        }
      return k;
    }


    std::unique_ptr<ExactSolution> make_harmonic(const SolutionCall         &call,
                                                 const ExactSolutionContext &context)
    {
      const std::array<double, 3> k    = wave_numbers(call, context);
      double                      rate = 0.;
      if (call.name == "lattice harmonic")
        {
          AssertThrow(
            !context.family.empty(),
            UserError(
              solution_entry +
              ": 'lattice harmonic' needs peridynamic nodes on a lattice; 'nonlocal harmonic' and "
              "'classical harmonic' do not."));
          rate = lattice_decay_rate(context.family, k, context.storage);
        }
      else if (call.name == "nonlocal harmonic")
        {
          AssertThrow(
            context.horizon > 0.,
            UserError(
              solution_entry +
              ": 'nonlocal harmonic' needs a horizon; give 'Horizon ratio' or 'Horizon' in section "
              "'Peridynamics'."));
          rate = nonlocal_decay_rate(context.dim,
                                     context.kernel,
                                     context.exponent,
                                     context.horizon,
                                     k,
                                     context.conductivity,
                                     context.storage);
        }
      else
        rate = classical_decay_rate(k, context.conductivity, context.storage);
      return std::make_unique<Harmonic>(context.lower, k, context.dim, rate);
    }


    std::unique_ptr<ExactSolution> make_series(const std::string          &name,
                                               const ExactSolutionContext &context)
    {
      if (name == "bobaru 2012 example 1")
        return std::make_unique<CoolingPlate>(context);
      BarSolution::Series series;
      const double        length = context.upper[0] - context.lower[0];
      if (name == "bobaru 2010 example 1")
        series = [](const double x, const double t) {
          const ValueAndSlope slab = HeatSeries::cooling_slab(x, t);
          return ValueAndSlope{100. * slab.value, 100. * slab.slope};
        };
      else if (name == "bobaru 2010 example 2")
        series = [](const double x, const double t) {
          return HeatSeries::two_part_bar(x, t, 60., 0., 100.);
        };
      else if (name == "bobaru 2010 example 3") // dT/dx = 3 at the right end
        series = [length](const double x, const double t) {
          return HeatSeries::heated_bar(x, t, 20., 3. * length);
        };
      else
        series = [](const double x, const double t) {
          return HeatSeries::heated_bar(x, t, 1., 0.);
        };
      return std::make_unique<BarSolution>(context, series);
    }
  } // namespace


  const std::vector<std::string> &exact_solution_names()
  {
    static const std::vector<std::string> names = {"bobaru 2010 example 1",
                                                   "bobaru 2010 example 2",
                                                   "bobaru 2010 example 3",
                                                   "bobaru 2012 example 1",
                                                   "bobaru 2012 example 2",
                                                   "lattice harmonic",
                                                   "nonlocal harmonic",
                                                   "classical harmonic"};
    return names;
  }


  std::unique_ptr<ExactSolution> make_exact_solution(const std::string          &text,
                                                     const ExactSolutionContext &context)
  {
    Assert(context.dim >= 1 && context.dim <= 3 && context.lower.size() >= context.dim &&
             context.upper.size() >= context.dim,
           ExcMessage("The context needs both corners of the box."));
    const auto       &names = exact_solution_names();
    const std::string clean = tidy(text);
    AssertThrow(!clean.empty(), UserError(solution_entry + " is empty."));
    const SolutionCall call     = take_apart(clean);
    const bool         known    = std::find(names.begin(), names.end(), call.name) != names.end();
    const bool         harmonic = known && call.name.find("harmonic") != std::string::npos;
    AssertThrow(!known || context.no_named.empty(),
                UserError(solution_entry + ": '" + call.name + "' " + context.no_named +
                          " Give an expression of x, y, z and t instead."));
    if (harmonic)
      return make_harmonic(call, context);
    if (known)
      {
        AssertThrow(!call.has_arguments,
                    UserError(solution_entry + ": '" + call.name + "' takes no arguments."));
        return make_series(call.name, context);
      }
    refuse_name_of_others(call, exact_solid_names(), "elastic bodies", names);
    try
      {
        return std::make_unique<ExpressionSolution>(text, context.dim);
      }
    catch (const UserError &)
      {
        refuse_unknown_name(call, names, "expressions of x, y, z and t");
        throw;
      }
  }


  namespace HeatSeries
  {
    namespace
    {
      const double pi = std::acos(-1.);
      const double first_time =
        1e-11; // below: the initial value; here a series has some 300,000 terms


      /**
       * Sum over n = 1, 3, 5, ... of coefficient(n) mode(n w x) exp(-(n w)^2 t), mode sine or
       * cosine. The coefficients must not grow. In n the terms fall faster than exp(-(n w)^2 t), n
       * w for the slope included, once that is below 1e-18.
       */
      template <typename Coefficient>
      ValueAndSlope sum_odd(const double       x,
                            const double       t,
                            const double       w,
                            const bool         sine,
                            const Coefficient &coefficient)
      {
        const double  period = 2. * pi / w;
        ValueAndSlope sum{0., 0.};
        for (double n = 1.;; n += 2.)
          {
            const double k = n * w, decay = std::exp(-k * k * t);
            // Relative to the slowest mode, which itself is small at late times.
            if (k * std::exp(-(k * k - w * w) * t) < 1e-17 * w)
              break;
            // Whole periods taken off first: exact at the ends, where the prescribed value must
            // come out.
            const double phase = w * std::remainder(n * x, period);
            const double c = coefficient(n) * decay, s = std::sin(phase), z = std::cos(phase);
            sum.value += c * (sine ? s : z);
            sum.slope += c * k * (sine ? z : -s);
          }
        return sum;
      }


      bool on_end(const double x, const double end)
      {
        return std::abs(x - end) < 1e-12;
      }
    } // namespace


    ValueAndSlope cooling_slab(const double x, const double t)
    {
      if (t < first_time)
        return {on_end(x, 0.) || on_end(x, 1.) ? 0. : 1., 0.};
      return sum_odd(x, t, pi, true, [](const double n) { return 4. / (n * pi); });
    }


    ValueAndSlope two_part_bar(const double x,
                               const double t,
                               const double first,
                               const double second,
                               const double right)
    {
      if (t < first_time)
        {
          if (on_end(x, 1.))
            return {right, 0.};
          // At the jump the mean, to which the series goes.
          return {on_end(x, 0.5) ? 0.5 * (first + second) : (x < 0.5 ? first : second), 0.};
        }
      const ValueAndSlope sum = sum_odd(x, t, 0.5 * pi, false, [&](const double n) {
        const double quarter = std::sin(0.25 * n * pi), half = std::sin(0.5 * n * pi);
        return 4. / (n * pi) * ((first - right) * quarter + (second - right) * (half - quarter));
      });
      return {right + sum.value, sum.slope};
    }


    ValueAndSlope heated_bar(const double x, const double t, const double left, const double slope)
    {
      if (t < first_time)
        return {on_end(x, 0.) ? left : 0., 0.};
      const ValueAndSlope sum = sum_odd(x, t, 0.5 * pi, true, [&](const double n) {
        const double k = 0.5 * n * pi;
        return -2. * (left / k + slope * std::sin(k) / (k * k));
      });
      return {left + slope * x + sum.value, slope + sum.slope};
    }
  } // namespace HeatSeries
} // namespace PeriDeal
