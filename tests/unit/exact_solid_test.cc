// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Exact displacements: gradients, equilibrium, what holds at holes, cracks, ends.

#include <perideal/analysis/exact_solid.h>

#include <cmath>

#include "scene_test_tools.h"

using namespace PeriDeal;

namespace
{
  using dealii::SymmetricTensor;

  ExactSolidContext plate(const PlaneState plane)
  {
    ExactSolidContext context;
    context.lower  = {-1., -0.5};
    context.upper  = {2., 0.5};
    context.moduli = moduli_from(Modulus::young, 3., Modulus::poisson, 0.3);
    context.plane  = plane;
    return context;
  }


  SymmetricTensor<2, 2> stress_at(const ExactSolution     &solution,
                                  const ExactSolidContext &context,
                                  const double             x,
                                  const double             y)
  {
    const double          p[2] = {x, y};
    double                g[2][2];
    SymmetricTensor<2, 2> strain;
    for (unsigned int c = 0; c < 2; ++c)
      EXPECT_TRUE(solution.gradient(p, 0., c, g[c]));
    for (unsigned int a = 0; a < 2; ++a)
      for (unsigned int b = a; b < 2; ++b)
        strain[a][b] = 0.5 * (g[a][b] + g[b][a]);
    return stress<2>(context.moduli, context.plane, strain);
  }


  /** Gradients are slopes of the values, and the stress has no divergence. */
  void check_field(const ExactSolution     &solution,
                   const ExactSolidContext &context,
                   const double             x,
                   const double             y)
  {
    constexpr double h    = 1e-4;
    const double     p[2] = {x, y};
    double           size = 0.;
    for (unsigned int c = 0; c < 2; ++c)
      {
        double g[2];
        solution.gradient(p, 0., c, g);
        size = std::max({size, std::abs(g[0]), std::abs(g[1])});
        for (unsigned int d = 0; d < 2; ++d)
          {
            double more[2] = {x, y}, less[2] = {x, y};
            more[d] += h;
            less[d] -= h;
            EXPECT_NEAR(g[d],
                        (solution.value(more, 0., c) - solution.value(less, 0., c)) / (2. * h),
                        1e-5 * size)
              << x << ' ' << y << ' ' << c << ' ' << d;
          }
      }
    const auto right = stress_at(solution, context, x + h, y),
               left  = stress_at(solution, context, x - h, y),
               above = stress_at(solution, context, x, y + h),
               below = stress_at(solution, context, x, y - h);
    for (unsigned int c = 0; c < 2; ++c)
      EXPECT_NEAR((right[c][0] - left[c][0] + above[c][1] - below[c][1]) / (2. * h),
                  0.,
                  1e-4 * size * context.moduli.young())
        << x << ' ' << y;
  }


  void expect_error(const std::string       &text,
                    const ExactSolidContext &context,
                    const std::string       &words)
  {
    SceneTests::expect_error([&] { make_exact_solid(text, context); }, {words});
  }
} // namespace


TEST(ExactSolid, kirsch)
{
  for (const PlaneState plane : {PlaneState::stress, PlaneState::strain})
    {
      ExactSolidContext context = plate(plane);
      context.hole              = {0.1, 0.2, 0.25};
      const auto solution       = make_exact_solid("kirsch(2)", context);
      check_field(*solution, context, 0.5, 0.5);
      check_field(*solution, context, -0.3, 0.1);
      // Three times the tension beside the hole, minus it in front of it; nothing on its rim.
      EXPECT_NEAR(stress_at(*solution, context, 0.1, 0.45)[0][0], 6., 1e-12);
      EXPECT_NEAR(stress_at(*solution, context, 0.35, 0.2)[1][1], -2., 1e-12);
      const double c = std::cos(0.7), s = std::sin(0.7);
      const auto   rim = stress_at(*solution, context, 0.1 + 0.25 * c, 0.2 + 0.25 * s);
      EXPECT_NEAR(rim[0][0] * c + rim[0][1] * s, 0., 1e-12);
      EXPECT_NEAR(rim[1][0] * c + rim[1][1] * s, 0., 1e-12);
      EXPECT_NEAR(stress_at(*solution, context, 1e4, 0.)[0][0], 2., 1e-6);
    }
}


TEST(ExactSolid, crack_tips)
{
  for (const PlaneState plane : {PlaneState::stress, PlaneState::strain})
    for (const bool turned : {false, true})
      {
        ExactSolidContext context = plate(plane);
        context.crack             = turned ? std::vector<double>{0.2, 0.1, 0.6, 2.} :
                                             std::vector<double>{-3., 0., 0.1, 0.};
        context.begins_inside     = turned;
        context.ends_inside       = !turned;
        const double tip[2]       = {turned ? 0.2 : 0.1, turned ? 0.1 : 0.};
        const auto   solution     = make_exact_solid("crack tip(3, 0.5)", context);
        for (const double angle : {0.3, 2., -2.8, 3.1})
          check_field(*solution,
                      context,
                      tip[0] + 0.4 * std::cos(angle),
                      tip[1] + 0.4 * std::sin(angle));
        EXPECT_EQ(solution->value(tip, 0., 0), 0.);
        if (turned)
          continue;
        // K_I and K_II ahead, nothing on the faces, no single value on the crack.
        const double r = 0.3, scale = std::sqrt(2. * dealii::numbers::PI * r);
        EXPECT_NEAR(stress_at(*solution, context, 0.1 + r, 0.)[1][1] * scale, 3., 1e-12);
        EXPECT_NEAR(stress_at(*solution, context, 0.1 + r, 0.)[0][1] * scale, 0.5, 1e-12);
        const auto face = stress_at(*solution, context, 0.1 - r, 1e-8);
        EXPECT_NEAR(face[1][1], 0., 1e-6);
        EXPECT_NEAR(face[0][1], 0., 1e-6);
        const double on[2] = {-0.4, 0.};
        EXPECT_TRUE(std::isnan(solution->value(on, 0., 1)));
      }
}


TEST(ExactSolid, westergaard)
{
  for (const PlaneState plane : {PlaneState::stress, PlaneState::strain})
    for (const double turn : {0., 0.6})
      {
        ExactSolidContext context = plate(plane);
        const double      c = std::cos(turn), s = std::sin(turn), a = 0.3;
        context.crack         = {0.2 - a * c, 0.1 - a * s, 0.2 + a * c, 0.1 + a * s};
        context.begins_inside = context.ends_inside = true;
        const auto solution = make_exact_solid("westergaard(2, 0.5)", context);
        for (const double angle : {0.3, 1., 2.4, -1.2})
          check_field(*solution, context, 0.2 + 0.7 * std::cos(angle), 0.1 + 0.4 * std::sin(angle));
        // Far away, beside the crack, and before its end: S sqrt(pi a)/sqrt(2 pi r).
        const auto along = [&](const double x, const double y) {
          const auto found =
            stress_at(*solution, context, 0.2 + x * c - y * s, 0.1 + x * s + y * c);
          const double across =
            found[0][0] * s * s - 2. * found[0][1] * s * c + found[1][1] * c * c;
          return std::make_pair(found[0][0] + found[1][1] - across, across);
        };
        EXPECT_NEAR(along(3e4, 1e4).first, 0.5, 1e-6);
        EXPECT_NEAR(along(3e4, 1e4).second, 2., 1e-6);
        EXPECT_NEAR(along(0.1, 1e-8).second, 0., 1e-6);
        const double r = 1e-6;
        EXPECT_NEAR(along(a + r, 0.).second * std::sqrt(2. * r / a), 2., 1e-5);
      }
}


TEST(ExactSolid, no_single_value_on_cracks_wherever_they_are)
{
  for (const double turn : {0., 0.6})
    {
      ExactSolidContext context = plate(PlaneState::stress);
      const double      c = std::cos(turn), s = std::sin(turn);
      context.crack         = {0.1, 0.3, 0.1 + 0.7 * c, 0.3 + 0.7 * s};
      context.begins_inside = context.ends_inside = true;
      const auto whole                            = make_exact_solid("westergaard(1)", context);
      context.begins_inside                       = false;
      const auto   tip                            = make_exact_solid("crack tip(1)", context);
      const double on[2]                          = {0.1 + 0.1 * 3. * c, 0.1 * 3. + 0.1 * 3. * s};
      const double at[2]                          = {context.crack[2], context.crack[3]};
      double       g[2];
      for (const auto *solution : {&whole, &tip})
        {
          EXPECT_TRUE(std::isnan((*solution)->value(on, 0., 1)));
          EXPECT_FALSE(std::isnan((*solution)->value(at, 0., 1)));
        }
      tip->gradient(at, 0., 0, g);
      EXPECT_TRUE(std::isnan(g[0]));
    }
}


TEST(ExactSolid, cantilever)
{
  for (const PlaneState plane : {PlaneState::stress, PlaneState::strain})
    {
      const ExactSolidContext context  = plate(plane);
      const auto              solution = make_exact_solid("cantilever(0.3)", context);
      check_field(*solution, context, 0.5, 0.3);
      check_field(*solution, context, 1.5, -0.1);
      const double root[2] = {-1., 0.};
      for (unsigned int component = 0; component < 2; ++component)
        EXPECT_EQ(solution->value(root, 0., component), 0.);
      for (const double y : {-0.5, 0.5})
        {
          const double corner[2] = {-1., y};
          EXPECT_NEAR(solution->value(corner, 0., 0), 0., 1e-15);
        }
      // Free above and below; the force at the right end.
      const auto above = stress_at(*solution, context, 0.7, 0.5);
      EXPECT_NEAR(above[1][1], 0., 1e-13);
      EXPECT_NEAR(above[0][1], 0., 1e-13);
      double             force = 0.;
      const unsigned int n     = 1000;
      for (unsigned int k = 0; k < n; ++k)
        force += stress_at(*solution, context, 2., -0.5 + (k + 0.5) / n)[0][1] / n;
      EXPECT_NEAR(force, -0.3, 1e-6);
    }
}


TEST(ExactSolid, standing_waves)
{
  for (unsigned int dim = 1; dim <= 3; ++dim)
    {
      ExactSolidContext context = plate(PlaneState::strain);
      context.dim               = dim;
      context.lower             = {-1., 0., 0.};
      context.upper             = {1., 1., 1.};
      context.density           = 2.;
      const double modulus  = dim == 1 ? 3. : context.moduli.lambda() + 2. * context.moduli.shear;
      const auto   solution = make_exact_solid("standing wave(3, 0.1)", context);
      const double x[3] = {0.3, 0.2, 0.1}, t = 0.4, h = 1e-4;
      double       left[3], right[3], before = 0., after = 0.;
      const double nearer[3] = {0.3 - h, 0.2, 0.1}, farther[3] = {0.3 + h, 0.2, 0.1};
      solution->gradient(nearer, t, 0, left);
      solution->gradient(farther, t, 0, right);
      before                    = solution->value(x, t - h, 0);
      after                     = solution->value(x, t + h, 0);
      const double acceleration = (after - 2. * solution->value(x, t, 0) + before) / (h * h);
      EXPECT_NEAR(2. * acceleration, modulus * (right[0] - left[0]) / (2. * h), 1e-5);
      EXPECT_NEAR(solution->value(context.lower.data(), t, 0), 0., 1e-15);
      EXPECT_NEAR(solution->value(context.upper.data(), t, 0), 0., 1e-15);
    }
}


TEST(ExactSolid, formulas_and_mistakes)
{
  ExactSolidContext context = plate(PlaneState::stress);
  const double      x[2]    = {0.5, 2.};
  double            g[2];
  const auto        formula = make_exact_solid("0.1*x + max(x, y)*t, -0.2*y", context);
  EXPECT_NEAR(formula->value(x, 3., 0), 6.05, 1e-15);
  EXPECT_NEAR(formula->value(x, 3., 1), -0.4, 1e-15);
  EXPECT_FALSE(formula->gradient(x, 0., 0, g));

  expect_error("krisch(1)", context, "did you mean 'kirsch'");
  expect_error("classical harmonic(1, 1)", context, "is for diffusion");
  expect_error("kirsch(1)", context, "circular hole");
  expect_error("westergaard(1)", context, "both ends");
  expect_error("crack tip(1)", context, "one end");
  expect_error("cantilever", context, "needs 1 number");
  expect_error("cantilever(x)", context, "constant");
  expect_error("standing wave(1.5)", context, "whole number");
  expect_error("0.1*x", context, "2 components");
  expect_error("0.1*x, y +", context, "'Solution'");
  context.has_holes = true;
  expect_error("cantilever(1)", context, "without holes");
  context.has_cracks = true;
  expect_error("kirsch(1)", context, "without cracks");
  context.dim = 1;
  expect_error("standin wave(1)", context, "did you mean 'standing wave'");
  context.has_cracks = context.has_holes = false;
  context.dim                            = 2;
  context.no_named                       = "is for another body.";
  expect_error("cantilever(1)", context, "another body");
}
