// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/study/observed_error.h>

#include <gtest/gtest.h>

#include <cmath>

namespace
{
  using namespace PeriDeal;

  /** Differences of solutions whose errors are one field times 3/fineness^p. */
  std::vector<ComparedSolution> steps_of(const std::vector<double> &finenesses, const double p)
  {
    std::vector<ComparedSolution> steps;
    double                        before = 0.;
    for (const double f : finenesses)
      {
        const double error = 3. / std::pow(f, p);
        steps.push_back({f, steps.empty() ? 0. : before - error});
        before = error;
      }
    return steps;
  }


  TEST(ObservedError, finds_order_and_error)
  {
    for (const double p : {1., 1.5, 2., 3.})
      for (const std::vector<double> &f :
           {std::vector<double>{4., 8., 16.}, {4., 10., 17.}, {3., 6., 18., 22.}})
        {
          const ObservedError found = observed_error(steps_of(f, p), 1., 3.);
          EXPECT_NEAR(found.order, p, 1e-6);
          EXPECT_NEAR(found.error / (3. / std::pow(f.back(), p)), 1., 1e-6);
        }
  }


  TEST(ObservedError, knows_little_of_few_solutions)
  {
    EXPECT_LT(observed_error({}, 1., 3.).error, 0.);
    EXPECT_LT(observed_error({{4., 0.}}, 1., 3.).error, 0.);
    const double two = 0.3 / (std::pow(2., 2.25) - 1.);
    EXPECT_NEAR(observed_error({{4., 0.}, {8., 0.3}}, 1., 3.).error, two, 1e-12);
    EXPECT_NEAR(observed_error({{4., 0.}, {8., 0.3}}, 1., 1.).error, 0.3, 1e-12);
    EXPECT_NEAR(largest_error({{4., 0.}, {8., 0.3}}), 0.3 / (std::pow(2., 1.25) - 1.), 1e-12);
  }


  TEST(ObservedError, is_not_misled_by_a_small_difference)
  {
    // Half of what the difference before has left, with the best order.
    const ObservedError found = observed_error({{4., 0.}, {8., 0.3}, {16., 1e-9}}, 1., 2.);
    EXPECT_NEAR(found.order, 2., 1e-6);
    EXPECT_NEAR(found.error, 0.5 * 0.1 / 4., 1e-8);
  }


  TEST(ObservedError, says_how_fine_a_mesh_has_to_be)
  {
    EXPECT_NEAR(fineness_for({0.04, 2.}, 10., 0.01, 3.), 20., 1e-9);
    EXPECT_NEAR(fineness_for({0.04, 2.}, 10., 1e-6, 3.), 30., 1e-9);
    EXPECT_NEAR(fineness_for({0.04, 2.}, 10., 0.05, 3.), 12., 1e-9);
  }
} // namespace
