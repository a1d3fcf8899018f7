// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/solvers/step_tools.h>
#include <perideal/solvers/stepper.h>

#include <gtest/gtest.h>

#include <cmath>

namespace PeriDeal
{
  namespace
  {
    struct Case
    {
      std::string  method;
      unsigned int n_stages;
      double       about; // the limit, to two digits
    };

    const std::vector<Case> cases = {{"euler", 0, 2.},
                                     {"rk4", 0, 2.785293563405282},
                                     {"verlet", 0, 2.},
                                     {"rkc2", 2, 2.},
                                     {"rkc2", 3, 6.187},
                                     {"rkc2", 4, 9.95},
                                     {"rkc2", 5, 17.},
                                     {"rkc2", 10, 65.},
                                     {"rkc2", 51, 1720.}};
  } // namespace


  /** |R| is 1 at the limit, nowhere above 1 before it, and above 1 behind it. */
  TEST(StepBounds, amplification_is_one_at_the_limit)
  {
    for (const Case &one : cases)
      {
        const double limit = stability_limit(one.method, one.n_stages);
        EXPECT_NEAR(amplification(one.method, limit, one.n_stages), 1., 1e-9) << one.method;
        EXPECT_NEAR(limit, one.about, 0.03 * one.about) << one.method << one.n_stages;
        for (unsigned int k = 0; k <= 2000; ++k)
          EXPECT_LE(amplification(one.method, k / 2000. * limit, one.n_stages), 1. + 1e-9)
            << one.method << ", " << one.n_stages << " stages, " << k;
        for (const double factor : {1.001, 1.1, 2.})
          EXPECT_GT(amplification(one.method, factor * limit, one.n_stages), 1. + 1e-6)
            << one.method << ", " << one.n_stages << " stages";
      }
  }


  TEST(StepBounds, slow_fields_decay_as_they_should)
  {
    constexpr double z = 1e-2;
    for (const Case &one : cases)
      if (one.method != "verlet")
        {
          EXPECT_NEAR(amplification(one.method, z, one.n_stages), std::exp(-z), 0.6 * z * z);
        }
  }


  TEST(StepBounds, rkc2_has_stages_enough)
  {
    for (double z = 1e-3; z < 1e7; z *= 1.07)
      {
        const unsigned int n = rkc2_stages(z);
        EXPECT_LE(z, stability_limit("rkc2", n));
        EXPECT_LT(amplification("rkc2", z, n), 1.);
        if (n > 3) // and no more than it needs
          {
            EXPECT_GT(z, 0.8 * stability_limit("rkc2", n - 2)) << n;
          }
      }
  }


  TEST(StepBounds, steps_of_steppers_are_these)
  {
    for (const std::string &name : stepper_names())
      {
        const double limit = stability_limit(name);
        EXPECT_EQ(std::isfinite(limit), name == "euler" || name == "rk4") << name;
        if (std::isfinite(limit))
          {
            EXPECT_DOUBLE_EQ(stable_step(name, 8.), limit / 8.);
          }
      }
    EXPECT_EQ(explicit_stepper_names(),
              (std::vector<std::string>{"euler", "rk4", "rkc2", "chebyshev"}));
  }
} // namespace PeriDeal
