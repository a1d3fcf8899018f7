// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/progress.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <string>
#include <thread>

namespace
{
  using namespace PeriDeal;

  /**
   * The largest factor, up or down, by which the remaining time leaves what was said before less
   * the time since, asked every 30 s.
   */
  double largest_jump(double (*share)(const double))
  {
    RemainingTime remaining;
    double        said = -1., worst = 1.;
    for (double spent = 30.; share(spent) < 0.97; spent += 30.)
      {
        const double now = remaining.update(spent, share(spent));
        EXPECT_GE(now, 0.);
        if (said > 60.)
          worst = std::max({worst, now / (said - 30.), (said - 30.) / std::max(now, 1e-9)});
        said = now;
      }
    return worst;
  }


  TEST(RemainingTime, IsExactWhereARunAdvancesEvenly)
  {
    RemainingTime remaining;
    for (double spent = 10.; spent < 1000.; spent += 10.)
      EXPECT_NEAR(remaining.update(spent, spent / 1000.), 1000. - spent, 1e-6);
  }


  TEST(RemainingTime, SaysNothingAtFirst)
  {
    EXPECT_LT(RemainingTime().update(1., 0.5), 0.);
    EXPECT_LT(RemainingTime().update(100., 1e-4), 0.);
  }


  TEST(RemainingTime, DoesNotJumpByFactors)
  {
    // A model that costs a tenth of the other, one after the other, in each of ten spans.
    const auto two_models = [](const double spent) {
      const double whole = std::floor(spent / 220.), rest = spent - 220. * whole;
      return 0.1 * (whole + (rest < 20. ? rest / 40. : 0.5 + (rest - 20.) / 400.));
    };
    // Ten times slower from the middle on: bonds begin to break.
    const auto slower = [](const double spent) {
      return spent < 300. ? spent / 600. : 0.5 + (spent - 300.) / 6000.;
    };
    EXPECT_LT(largest_jump(two_models), 1.7);
    EXPECT_LT(largest_jump(slower), 1.7);
  }


  TEST(RemainingTime, GrowsWhereNothingGetsDone)
  {
    // The last fifth takes two minutes in which bonds break: told each second.
    RemainingTime remaining;
    double        said = 0.;
    for (int second = 4; second <= 10; ++second)
      said = remaining.update(second, 0.08 * second);
    EXPECT_LT(said, 3.);
    for (int second = 11; second <= 130; ++second)
      {
        const double now = remaining.update(second, 0.8);
        EXPECT_GE(now, said);
        said = now;
      }
    EXPECT_GT(said, 0.5 * 130. / 4.);
  }


  TEST(Progress, ALogHasALineInEachInterval)
  {
    setenv("PERIDEAL_PROGRESS", "lines", 1);
    testing::internal::CaptureStdout();
    {
      Progress progress(MPI_COMM_SELF, false, 0.2); // on each process: only the first one tells
      progress.begin("time");
      progress.doing("peridynamics: time stepping");
      progress.state("force 12 on top in y");
      progress.advancing(0., 2., 0., 1.);
      tell_step(0.5);
      tell_broken_bonds(7);
      std::this_thread::sleep_for(std::chrono::milliseconds(700));
    }
    unsetenv("PERIDEAL_PROGRESS");
    const std::string text = testing::internal::GetCapturedStdout();
    EXPECT_GE(std::count(text.begin(), text.end(), '\n'), 2);
    for (const std::string words : {"time 25 %: t = 0.5, step 1, peridynamics: time stepping",
                                    "force 12 on top in y, 7 broken bonds",
                                    "elapsed"})
      EXPECT_NE(text.find(words), std::string::npos) << text;
    tell_broken_bonds(0);
  }


  TEST(Progress, NobodyKnowsHowManyEquilibriaAreToCome)
  {
    setenv("PERIDEAL_PROGRESS", "lines", 1);
    testing::internal::CaptureStdout();
    {
      Progress progress(MPI_COMM_SELF, false, 0.1);
      progress.begin("time");
      progress.update(0.8);
      tell_broken_bonds(26);
      for (int k = 0; k < 45; ++k)
        tell_equilibrium();
      std::this_thread::sleep_for(std::chrono::milliseconds(250));
    }
    unsetenv("PERIDEAL_PROGRESS");
    const std::string text = testing::internal::GetCapturedStdout();
    EXPECT_NE(text.find("equilibrium 45, 26 broken bonds"), std::string::npos) << text;
    EXPECT_NE(text.find("time left unknown"), std::string::npos) << text;
    tell_broken_bonds(0);
  }


  TEST(Progress, QuietRunsSayNothing)
  {
    testing::internal::CaptureStdout();
    {
      Progress progress(MPI_COMM_WORLD, true, 0.05);
      progress.begin("time");
      progress.doing("something");
      std::this_thread::sleep_for(std::chrono::milliseconds(150));
    }
    EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  }
} // namespace
