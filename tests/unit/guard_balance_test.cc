// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Balances that the guards of a run watch, and how much there is to be kept.

#include <perideal/problems/guards.h>
#include <perideal/solvers/stepper.h>

#include <cmath>

#include "operator_test_tools.h"
#include "scene_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using namespace SceneTests;
  using dealii::Point;

  namespace
  {
    const Settings plate{{"Domain/Cells", "12, 12"},
                         {"Peridynamics/Boundary treatment", "fictitious mirror"},
                         {"Boundary conditions/Dirichlet", "left: 1; right: 0"},
                         {"Boundary conditions/Convection", "top: 3, 2"},
                         {"Initial and source/Source", "10*exp(-20*((x-0.5)^2 + (y-0.5)^2))"}};

    struct Kept
    {
      Trip   trip;
      double share = 0.; // missing at the end
    };


    /**
     * Four spans of 0.005, after each of which the balance is looked at as in a run.
     * @param added to the temperature of the middle after the second, behind the stepper's back
     */
    Kept run_balance(const OperatorTests::Problem<2> &problem,
                     const std::string               &stepper_name,
                     const double                     added = 0.)
    {
      constexpr double   span = 0.005;
      DiffusionOperator &op   = problem.op();
      const auto         made = make_stepper(stepper_name, op, StepperOptions());
      Vector             u    = problem.values([](const auto &) { return 0.; });
      op.distribute(u, 0.);
      HeatLedger ledger;
      ledger.begin(op.balance(u, 0., false).content);
      Kept kept;
      for (unsigned int k = 0; k < 4 && !kept.trip; ++k)
        {
          made->advance(u, k * span, (k + 1) * span);
          if (k == 1)
            for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
              if (problem.positions[i].distance(Point<2>(0.5, 0.5)) < 1e-9)
                u.local_element(i) += added;
          const double            t       = (k + 1) * span;
          const Balance           balance = op.balance(u, t, false);
          const CumulativeBalance found =
            ledger.balance(made->entered(), balance.content, MPI_COMM_WORLD);
          ledger.keep(found, 0., 0., t);
          kept.trip  = heat_lost(op, ledger, "heat", t);
          kept.share = std::abs(found.imbalance()) / ledger.most_moved();
        }
      return kept;
    }


    /** An archive of a run with a ledger as it was when it kept two numbers alone. */
    void exchange_as_before(Archive &archive, double content_at_start, double came_otherwise)
    {
      archive.exchange("content at start", content_at_start);
      archive.exchange("came otherwise", came_otherwise);
    }
  } // namespace


  TEST(GuardBalance, all_steppers_keep_heat)
  {
    for (const ModelKind model : {ModelKind::peridynamics, ModelKind::finite_elements})
      {
        const OperatorTests::Problem<2> problem(plate, model);
        for (const std::string &name : stepper_names())
          {
            const Kept kept = run_balance(problem, name);
            EXPECT_FALSE(kept.trip) << name << ": " << kept.trip.found;
            // What the expansion is cut off at; solvers stop at 1e-10 of the residual.
            const bool expands = name == "auto" || name == "chebyshev";
            EXPECT_LT(kept.share, expands ? StepperOptions().tolerance : 1e-9) << name;
          }
      }
  }


  TEST(GuardBalance, heat_from_nowhere)
  {
    const OperatorTests::Problem<2> problem(plate);
    for (const double added : {5., -5.})
      for (const std::string name : {"euler", "chebyshev", "sdirk2"})
        {
          const Trip trip = run_balance(problem, name, added).trip;
          EXPECT_EQ(trip.monitor, "balance") << name;
          EXPECT_DOUBLE_EQ(trip.time, 0.01);
          EXPECT_NEAR(trip.value, 5. / 144., 1e-6); // one cell's share of the plate
          EXPECT_GT(trip.value, trip.bound);
          EXPECT_NE(trip.found.find(added > 0. ? "has not come in" : "is not in the body"),
                    std::string::npos)
            << trip.found;
        }
  }


  TEST(GuardBalance, models_that_lose_heat)
  {
    // The papers' self term: more than the share goes, and nobody is to be stopped for it.
    const OperatorTests::Problem<2> problem(
      plate + Settings{{"Peridynamics/Self term", "paper"}, {"Material/Conductivity", "1 + 9*x"}});
    const Kept kept = run_balance(problem, "euler");
    EXPECT_FALSE(kept.trip);
    EXPECT_GT(kept.share, 0.01);
    EXPECT_FALSE(problem.op().symmetric());
  }


  TEST(GuardBalance, what_has_come_and_gone_counts)
  {
    // A pulse brings 5 in, which leaves again until the first totals.
    HeatLedger ledger;
    ledger.begin(2.);
    for (const double entered : {0., 3., 5., 4., 1., 1e-9})
      ledger.see(this_process() == 0 ? entered : 0., MPI_COMM_WORLD);
    ledger.keep({1e-9, 0.}, 0.1, 7., 1.);
    EXPECT_NEAR(ledger.most_moved(),
                10.,
                1e-8); // in and out; the rate at that moment counts for nothing
    // A load that ends: nothing enters any more at t = 2. Later 3 and 4 per time enter.
    ledger.keep({1e-9, 0.}, 0.1, 0., 2.);
    EXPECT_NEAR(ledger.most_moved(), 10., 1e-8);
    ledger.keep({1e-9, 0.}, 0.1, 3., 6.);
    EXPECT_NEAR(ledger.most_moved(), 10., 1e-8);
    ledger.keep({1e-9, 0.}, 0.1, 4., 12.);
    EXPECT_NEAR(ledger.most_moved(), 18., 1e-8);
    // A new run.
    ledger.begin(2.);
    EXPECT_EQ(ledger.most_moved(), 0.);
  }


  TEST(GuardBalance, is_resumed)
  {
    HeatLedger ledger, other, without;
    ledger.begin(2.);
    ledger.add(0.5);
    ledger.keep({3., 1.}, 0.1, 7., 1.);
    ledger.keep({3., 1.}, 0.1, 6., 2.);
    MemoryArchive saved(MPI_COMM_WORLD), before(MPI_COMM_WORLD);
    ledger.exchange(saved);
    MemoryArchive loaded(saved, MPI_COMM_WORLD);
    other.exchange(loaded);
    const double next = ledger.most_moved() + 12.; // two more times of 6
    for (HeatLedger *const one : {&ledger, &other})
      {
        one->keep({3., 1.}, 0.1, 6., 4.);
        EXPECT_DOUBLE_EQ(one->most_moved(), next);
        EXPECT_DOUBLE_EQ(one->balance(0., 2., MPI_COMM_WORLD).entered, 0.5);
      }
    // From a checkpoint that has no more than two numbers.
    exchange_as_before(before, 2., 0.5);
    MemoryArchive old(before, MPI_COMM_WORLD);
    without.exchange(old);
    EXPECT_DOUBLE_EQ(without.at_start(), 2.);
    EXPECT_DOUBLE_EQ(without.balance(0., 5., MPI_COMM_WORLD).entered, 0.5);
    EXPECT_EQ(without.most_moved(), 0.);
    without.keep({0.5, 3.}, 0.1, 6., 4.);
    EXPECT_DOUBLE_EQ(without.most_moved(), 3.);
  }


  TEST(GuardBalance, of_forces)
  {
    const Trip trip = balance_broken("their sum is 2", -2., "the largest force", 100., 0.5);
    EXPECT_EQ(trip.monitor, "balance");
    EXPECT_DOUBLE_EQ(trip.value, 2.);
    EXPECT_DOUBLE_EQ(trip.bound, 1.);
    EXPECT_DOUBLE_EQ(trip.time, 0.5);
    EXPECT_EQ(trip.found, "their sum is 2, 2 % of the largest force and more than 1 %");
    EXPECT_FALSE(balance_broken("", 0.99, "", 100., 0.));
    EXPECT_FALSE(balance_broken("", 0., "", 0., 0.)); // where there is nothing at all
  }
} // namespace PeriDeal
