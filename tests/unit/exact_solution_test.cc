// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Exact solutions: the series of the papers against the equation they solve, and the decay rates of
// waves.

#include <perideal/analysis/decay_rate.h>
#include <perideal/analysis/exact_solution.h>
#include <perideal/laws/gauss_rule.h>
#include <perideal/laws/kernel.h>

#include <cmath>

#include "scene_test_tools.h"

using namespace PeriDeal;

namespace
{
  const double pi = std::acos(-1.);


  ExactSolutionContext box(const std::vector<double> &lower,
                           const std::vector<double> &upper,
                           const double               alpha)
  {
    ExactSolutionContext context;
    context.dim          = static_cast<unsigned int>(lower.size());
    context.lower        = lower;
    context.upper        = upper;
    context.conductivity = 3. * alpha; // so that the storage counts
    context.storage      = 3.;
    return context;
  }


  /** The order of errors on lattices each twice as fine as the one before, by least squares. */
  double order_of_halving(const std::vector<double> &errors)
  {
    const double middle   = 0.5 * (errors.size() - 1.);
    double       products = 0., squares = 0.;
    for (std::size_t k = 0; k < errors.size(); ++k)
      {
        products -= (k - middle) * std::log2(errors[k]);
        squares += (k - middle) * (k - middle);
      }
    return products / squares;
  }


  double value(const std::unique_ptr<ExactSolution> &solution,
               const std::vector<double>            &x,
               const double                          t)
  {
    return solution->value(x.data(), t);
  }


  /** dT/dt = alpha Laplace T and the gradient, by central differences. */
  void expect_heat_equation(const std::string         &name,
                            const std::vector<double> &lower,
                            const std::vector<double> &upper,
                            const double               alpha,
                            const double               t)
  {
    const auto                solution = make_exact_solution(name, box(lower, upper, alpha));
    const double              step = 5e-4 * (upper[0] - lower[0]), dt = 1e-4 * t;
    const std::vector<double> at{{0.13, 0.5, 0.81}};
    for (const double a : at)
      {
        std::vector<double> x(lower.size()), g(lower.size());
        for (unsigned int d = 0; d < x.size(); ++d)
          x[d] = lower[d] + (d == 0 ? a : 0.37) * (upper[d] - lower[d]);
        const double rate  = (value(solution, x, t + dt) - value(solution, x, t - dt)) / (2. * dt);
        double       right = 0.;
        ASSERT_TRUE(solution->gradient(x.data(), t, g.data()));
        for (unsigned int d = 0; d < x.size(); ++d)
          {
            std::vector<double> plus = x, minus = x;
            plus[d] += step;
            minus[d] -= step;
            const double p = value(solution, plus, t), m = value(solution, minus, t);
            right += alpha * (p - 2. * value(solution, x, t) + m) / (step * step);
            EXPECT_NEAR(g[d], (p - m) / (2. * step), 1e-4 * (std::abs(g[d]) + 1.)) << name;
          }
        EXPECT_NEAR(rate, right, 1e-4 * (std::abs(rate) + 1.)) << name << " x " << a;
      }
  }


  std::string error_of(const std::string &text, const ExactSolutionContext &context)
  {
    return SceneTests::message_of([&] { make_exact_solution(text, context); });
  }


  /** Rate of the lattice with spacing delta/m over that of the continuum, minus one. */
  template <int dim>
  double lattice_excess(const double m, const KernelShape shape, const unsigned int n)
  {
    const std::array<double, 3> k{{2., dim > 1 ? 1. : 0., dim > 2 ? 1.5 : 0.}};
    dealii::Tensor<1, dim>      h;
    for (unsigned int d = 0; d < dim; ++d)
      h[d] = 1. / m;
    const auto family =
      lattice_family<dim>(h, 1., shape, n, VolumeFraction::linear, Calibration::discrete);
    return lattice_decay_rate(lattice_terms<dim>(family, h, 1.), k, 1.) /
             nonlocal_decay_rate(dim, shape, n, 1., k, 1., 1.) -
           1.;
  }
} // namespace


TEST(ExactSolution, MidTemperaturesOfBobaru2010)
{
  const auto context = box({0.}, {10.}, 1.14);
  EXPECT_NEAR(value(make_exact_solution("Bobaru 2010 Example 1", context), {5.}, 8.), 51.748, 5e-4);
  EXPECT_NEAR(value(make_exact_solution(" bobaru 2010  example 2", context), {5.}, 8.),
              53.063,
              5e-4);
}


TEST(ExactSolution, SeriesSolveTheHeatEquation)
{
  for (const double t : {0.5, 8.})
    {
      expect_heat_equation("bobaru 2010 example 1", {-1.}, {9.}, 1.14, t);
      expect_heat_equation("bobaru 2010 example 2", {-1.}, {9.}, 1.14, t);
      expect_heat_equation("bobaru 2010 example 3", {0.}, {10.}, 1.14, t);
    }
  expect_heat_equation("bobaru 2010 example 3", {0.}, {pi}, 1.14, 0.4);
  expect_heat_equation("bobaru 2012 example 1", {0., 0.}, {10., 15.}, 1.14, 5.);
  expect_heat_equation("bobaru 2012 example 2", {0., 0.}, {10., 10.}, 1., 8.);
}


TEST(ExactSolution, InitialAndBoundaryValues)
{
  const auto bar = box({-1.}, {9.}, 1.14), pi_bar = box({0.}, {pi}, 1.14),
             square = box({0., 0.}, {1., 1.}, 1.);
  const auto one    = make_exact_solution("bobaru 2010 example 1", bar);
  const auto two    = make_exact_solution("bobaru 2010 example 2", bar);
  const auto three  = make_exact_solution("bobaru 2010 example 3", pi_bar);
  const auto plate  = make_exact_solution("bobaru 2012 example 1", square);
  const auto wall   = make_exact_solution("bobaru 2012 example 2", square);
  for (const double t : {0., 1e-6, 0.01, 1., 30.})
    {
      EXPECT_NEAR(value(one, {-1.}, t), 0., 1e-11);
      EXPECT_NEAR(value(one, {9.}, t), 0., 1e-11);
      EXPECT_NEAR(value(two, {9.}, t), 100., 1e-11);
      EXPECT_NEAR(value(three, {0.}, t), 20., 1e-11);
      EXPECT_NEAR(value(plate, {0.3, 1.}, t), 0., 1e-11);
      EXPECT_NEAR(value(wall, {0., 0.4}, t), 1., 1e-11);
      if (t > 0.)
        {
          double g[2];
          two->gradient(std::vector<double>{-1.}.data(), t, g);
          EXPECT_NEAR(g[0], 0., 1e-9);
          three->gradient(std::vector<double>{pi}.data(), t, g);
          EXPECT_NEAR(g[0], 3., 1e-9);
          wall->gradient(std::vector<double>{1., 0.2}.data(), t, g);
          EXPECT_NEAR(g[0], 0., 1e-9);
          EXPECT_EQ(g[1], 0.);
        }
    }
  // Soon after the start it is still as at the start where the sides are far, at t = 0 exactly so.
  for (const double t : {0., 1e-5, 1e-3})
    {
      EXPECT_NEAR(value(one, {4.}, t), 100., 1e-10);
      EXPECT_NEAR(value(two, {0.}, t), 60., 1e-10);
      EXPECT_NEAR(value(two, {6.}, t), 0., 1e-10);
      EXPECT_NEAR(value(two, {4.}, t), 30., 1e-10);
      EXPECT_NEAR(value(three, {1.5}, t), 0., 1e-10);
      EXPECT_NEAR(value(plate, {0.5, 0.4}, t), 40., 1e-4);
      EXPECT_NEAR(value(wall, {0.5, 0.4}, t), 0., 1e-10);
    }
  EXPECT_NEAR(value(three, {2.}, 1e3), 20. + 3. * 2., 1e-10);
}


// Near a wall at an early time: the half space erf(x/sqrt(4 alpha t)).
TEST(ExactSolution, EarlyTimesAreTheHalfSpace)
{
  const auto solution = make_exact_solution("bobaru 2010 example 1", box({0.}, {10.}, 1.14));
  for (const double t : {1e-8, 1e-4, 0.01})
    for (const double z : {0.2, 1., 2.})
      EXPECT_NEAR(value(solution, {z * std::sqrt(4. * 1.14 * t)}, t), 100. * std::erf(z), 1e-9);
}


TEST(ExactSolution, NonlocalRateByBruteForce)
{
  // Product Gauss rules in polar and in spherical coordinates for the plain integrand with the
  // product of cosines.
  const GaussRule             rule(40);
  const std::array<double, 3> k{{2., 1., 1.5}};
  const double                delta = 0.9;
  for (const KernelShape shape :
       {KernelShape::constant, KernelShape::conical, KernelShape::gaussian})
    for (unsigned int n = 0; n <= 2; ++n)
      {
        const auto radial = [&](const unsigned int dim, const auto &one_minus) {
          return micro_conductivity(dim, shape, n, delta, 1.3) / 2.5 *
                 rule.integrate(0., delta, [&](const double r) {
                   return kernel_shape(shape, r, delta) *
                          std::pow(r, static_cast<int>(dim) - 1 - static_cast<int>(n)) *
                          one_minus(r);
                 });
        };
        const double line =
          radial(1, [&](const double r) { return 4. * std::pow(std::sin(0.5 * k[0] * r), 2); });
        EXPECT_NEAR(nonlocal_decay_rate(1, shape, n, delta, {{k[0], 0., 0.}}, 1.3, 2.5),
                    line,
                    1e-12);
        const double plane = radial(2, [&](const double r) {
          return rule.integrate(0., 2. * pi, [&](const double a) {
            return 1. - std::cos(k[0] * r * std::cos(a)) * std::cos(k[1] * r * std::sin(a));
          });
        });
        EXPECT_NEAR(nonlocal_decay_rate(2, shape, n, delta, {{k[0], k[1], 0.}}, 1.3, 2.5),
                    plane,
                    1e-11);
        const double space = radial(3, [&](const double r) {
          return rule.integrate(-1., 1., [&](const double z) {
            const double s = std::sqrt(1. - z * z);
            return rule.integrate(0., 2. * pi, [&](const double a) {
              return 1. - std::cos(k[0] * r * s * std::cos(a)) *
                            std::cos(k[1] * r * s * std::sin(a)) * std::cos(k[2] * r * z);
            });
          });
        });
        EXPECT_NEAR(nonlocal_decay_rate(3, shape, n, delta, k, 1.3, 2.5), space, 1e-11);
      }
  // Short waves: all kernels end in the full sum of k/r^n where that is finite.
  EXPECT_NEAR(nonlocal_decay_rate(3, KernelShape::constant, 0, 1., {{1e4, 0., 0.}}, 1., 1.),
              micro_conductivity(3, KernelShape::constant, 0, 1.) * 4. * pi / 3.,
              1e-5);
}


TEST(ExactSolution, NonlocalRateGoesToTheClassicalOneWithOrderTwo)
{
  for (unsigned int dim = 1; dim <= 3; ++dim)
    for (const KernelShape shape :
         {KernelShape::constant, KernelShape::conical, KernelShape::gaussian})
      for (unsigned int n = 0; n <= 2; ++n)
        {
          const std::array<double, 3> k{{pi, dim > 1 ? 2. * pi : 0., dim > 2 ? pi : 0.}};
          const double                classical = classical_decay_rate(k, 1.14, 2.);
          std::vector<double>         horizons{{0.04, 0.02, 0.01}}, errors;
          for (const double delta : horizons)
            errors.push_back(classical - nonlocal_decay_rate(dim, shape, n, delta, k, 1.14, 2.));
          for (unsigned int i = 0; i + 1 < horizons.size(); ++i)
            EXPECT_NEAR(order_of_halving({errors[i], errors[i + 1]}), 2., 0.01);
          EXPECT_LT(errors.back(), 2e-3 * classical);
        }
}


// In 2D and 3D with order two in 1/m. In 1D with n = 2 with order one: what the node's own cell
// would conduct is missing.
TEST(ExactSolution, LatticeRateGoesToTheNonlocalOne)
{
  const std::vector<double> spacings{{1. / 8., 1. / 16., 1. / 32., 1. / 64.}};
  const auto                order = [&](const auto &excess) {
    std::vector<double> errors;
    for (const double h : spacings)
      errors.push_back(std::abs(excess(1. / h)));
    return order_of_halving(errors);
  };
  EXPECT_NEAR(order([](double m) { return lattice_excess<2>(m, KernelShape::conical, 2); }),
              2.,
              0.05);
  EXPECT_NEAR(order([](double m) { return lattice_excess<1>(m, KernelShape::constant, 1); }),
              2.,
              0.05);
  EXPECT_NEAR(order([](double m) { return lattice_excess<1>(m, KernelShape::conical, 2); }),
              1.,
              0.1);
  EXPECT_LT(std::abs(lattice_excess<2>(64., KernelShape::conical, 2)), 1e-4);
  EXPECT_NEAR(std::log2(lattice_excess<3>(8., KernelShape::conical, 2) /
                        lattice_excess<3>(16., KernelShape::conical, 2)),
              2.,
              0.3);
}


TEST(ExactSolution, Harmonics)
{
  ExactSolutionContext context = box({0., -1.}, {1., 1.}, 1.14);
  context.horizon              = 0.3;
  const dealii::Tensor<1, 2> h({0.1, 0.1});
  context.family = lattice_terms<2>(lattice_family<2>(h,
                                                      0.3,
                                                      context.kernel,
                                                      context.exponent,
                                                      VolumeFraction::linear,
                                                      Calibration::discrete),
                                    h,
                                    context.conductivity);
  const std::array<double, 3> k{{pi, pi, 0.}};
  const std::vector<double>   x{{0.3, -0.2}};
  const double                shape = std::sin(pi * 0.3) * std::sin(pi * 0.8), t = 0.02;
  EXPECT_NEAR(value(make_exact_solution("classical harmonic(1, 2)", context), x, t),
              shape * std::exp(-1.14 * 2. * pi * pi * t),
              1e-14);
  EXPECT_NEAR(value(make_exact_solution("nonlocal harmonic(1,2)", context), x, t),
              shape *
                std::exp(-t * nonlocal_decay_rate(2, KernelShape::conical, 2, 0.3, k, 1.14, 1.)),
              1e-14);

  // The lattice harmonic: the semi-discrete equation holds at a node with the whole sum written
  // out.
  const auto   lattice = make_exact_solution("Lattice Harmonic( 1 , 2 )", context);
  double       sum     = 0.;
  const double dt      = 1e-5;
  for (const LatticeTerm &term : context.family)
    sum += term.coefficient *
           (value(lattice, {x[0] + term.xi[0], x[1] + term.xi[1]}, t) - value(lattice, x, t));
  EXPECT_NEAR(context.storage * (value(lattice, x, t + dt) - value(lattice, x, t - dt)) / (2. * dt),
              sum,
              1e-6);
  double g[2];
  ASSERT_TRUE(lattice->gradient(x.data(), t, g));
  EXPECT_NEAR(g[1],
              (value(lattice, {x[0], x[1] + 1e-4}, t) - value(lattice, {x[0], x[1] - 1e-4}, t)) /
                2e-4,
              1e-6);
}


TEST(ExactSolution, ExpressionsAndMistakes)
{
  ExactSolutionContext context = box({0., 0.}, {1., 1.}, 1.);
  const auto           formula = make_exact_solution("2*x + y*t", context);
  EXPECT_NEAR(value(formula, {0.5, 3.}, 2.), 7., 1e-14);
  double g[2];
  EXPECT_FALSE(formula->gradient(std::vector<double>{0., 0.}.data(), 0., g));
  EXPECT_NEAR(value(make_exact_solution("(sin(x))", context), {0.5, 3.}, 2.), std::sin(0.5), 1e-15);

  SceneTests::expect_parts(error_of("bobaru 2010 exmaple 1", context),
                           {"did you mean 'bobaru 2010 example 1'"});
  SceneTests::expect_parts(error_of("latice harmonic(1,1)", context),
                           {"did you mean 'lattice harmonic'"});
  SceneTests::expect_parts(error_of("kirsch(1)", context), {"is for elastic bodies"});
  SceneTests::expect_parts(error_of("bobaru", context), {"Known are"});
  EXPECT_NE(error_of("2*x +", context), "");
  EXPECT_EQ(error_of("2*x +", context).find("Known are"), std::string::npos);
  EXPECT_NE(error_of("", context), "");
  for (const std::string arguments :
       {"", "()", "(1)", "(1,2,3)", "(1,0)", "(1,-2)", "(1,x)", "(1,2", "(1.5,2)"})
    EXPECT_NE(error_of("classical harmonic" + arguments, context), "") << arguments;
  SceneTests::expect_parts(error_of("lattice harmonic(1,1)", context), {"lattice"});
  SceneTests::expect_parts(error_of("nonlocal harmonic(1,1)", context), {"'Horizon ratio'"});
  SceneTests::expect_parts(error_of("bobaru 2012 example 2(1)", context), {"no arguments"});
  SceneTests::expect_parts(error_of("bobaru 2012 example 1", box({0.}, {1.}, 1.)),
                           {"two-dimensional"});
}
