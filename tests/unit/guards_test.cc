// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// What the guards of a run find, and how soon; and what they leave alone.

#include <deal.II/base/mpi.h>

#include <perideal/base/worst_trip.h>
#include <perideal/problems/guards.h>
#include <perideal/scene/expression.h>
#include <perideal/scene/not_positive.h>
#include <perideal/solvers/motion_stepper.h>
#include <perideal/solvers/stepper.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "elastic_test_tools.h"
#include "scene_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using namespace SceneTests;
  using dealii::Point;
  using dealii::Tensor;

  namespace
  {
    const Extent zero_to_one{0., 1., true};

    constexpr unsigned int soon = 20; // steps after the first growth

    const Settings plate{{"Domain/Cells", "12, 12"},
                         {"Peridynamics/Boundary treatment", "fictitious mirror"},
                         {"Boundary conditions/Dirichlet", "left: 0; right: 1"}};
    const Settings heated =
      plate + Settings{{"Initial and source/Source", "10*exp(-20*((x-0.5)^2 + (y-0.5)^2))"}};


    template <int dim>
    PlaceOfNode places(const OperatorTests::Problem<dim> &problem)
    {
      return [&](const unsigned int node) {
        return std::vector<double>(problem.positions[node].begin_raw(),
                                   problem.positions[node].end_raw());
      };
    }


    struct Outcome
    {
      Trip                        trip;
      std::optional<unsigned int> first_growth, stopped; // steps
    };


    /** Forward Euler with steps of a share of the stable one, and looks as a run has them. */
    Outcome step_with_euler(const Settings &settings,
                            const double    share,
                            const Extent   *given = nullptr,
                            const double    noise = 0.)
    {
      constexpr unsigned int          n_steps = 3000, between = 10;
      const OperatorTests::Problem<2> problem(settings);
      StepperOptions                  options;
      options.time_step    = share * stable_step("euler", problem.op().spectrum().sharp);
      const auto   stepper = make_euler(problem.op(), options); // which refuses no step
      const double dt      = options.time_step;
      Vector       u       = problem.values(
        [&](const auto &p) { return noise * std::sin(97. * p[0]) * std::cos(89. * p[1]); });
      problem.op().distribute(u, 0.);
      GrowthGuard guard;
      const auto  look = [&](const double t) {
        return guard.look(problem.op(), u, t, given, places(problem), "temperature");
      };
      EXPECT_FALSE(look(0.));
      const Extent start = extent_of(u);
      Outcome      run;
      for (unsigned int k = 1, since = 0; k <= n_steps; ++k)
        {
          stepper->advance(u, (k - 1) * dt, k * dt);
          const Extent now   = extent_of(u);
          const double after = std::max(now.most - start.most, start.least - now.least);
          if (!run.first_growth && after > start.width())
            run.first_growth = k;
          if (++since < (guard.suspects() ? 1 : between))
            continue;
          since    = 0;
          run.trip = look(k * dt);
          if (run.trip)
            {
              run.stopped = k;
              break;
            }
        }
      return run;
    }
  } // namespace


  TEST(Guards, extents)
  {
    const OperatorTests::Problem<2> problem(plate);
    Vector                          u = problem.values([](const auto &p) { return p[0] - 0.25; });
    EXPECT_DOUBLE_EQ(extent_of(u).most, 0.75);
    EXPECT_DOUBLE_EQ(extent_of(u).least, -0.25);
    EXPECT_DOUBLE_EQ(extent_of(u).size(), 0.75);
    for (const double none :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
      {
        u = problem.values(
          [&](const auto &p) { return p.distance(Point<2>(0.5, 0.75)) < 1e-9 ? none : 0.; });
        EXPECT_FALSE(extent_of(u).finite);
        const Trip trip = values_not_finite(u, 1, places(problem), "temperature", 0.3);
        EXPECT_EQ(trip.monitor, "finite values");
        ASSERT_EQ(trip.place.size(), 2u);
        EXPECT_NEAR(trip.place[0], 0.5, 1e-12);
        EXPECT_NEAR(trip.place[1], 0.75, 1e-12);
        EXPECT_DOUBLE_EQ(trip.time, 0.3);
        expect_parts(trip.found, {"temperature at (0.5, 0.75)"});
      }
  }


  TEST(Guards, euler_above_its_limit)
  {
    const Outcome isolated = step_with_euler(plate, 1.03, &zero_to_one);
    ASSERT_TRUE(isolated.stopped && isolated.first_growth);
    EXPECT_EQ(isolated.trip.monitor, "maximum principle");
    EXPECT_GE(*isolated.stopped, *isolated.first_growth);
    EXPECT_LE(*isolated.stopped, *isolated.first_growth + soon);
    EXPECT_GT(std::abs(isolated.trip.value - 0.5), 1.5); // from the middle, beyond twice the range

    const Outcome loaded = step_with_euler(heated, 1.03);
    ASSERT_TRUE(loaded.stopped && loaded.first_growth);
    EXPECT_EQ(loaded.trip.monitor, "growth");
    EXPECT_LE(*loaded.stopped, *loaded.first_growth + soon);
    expect_parts(loaded.trip.found, {"the steps make it grow, not the loads"});
  }


  TEST(Guards, slow_growth)
  {
    // Waves of the mesh that gain 0.6 to 3 % in a step, change sign each time, and have crests that
    // lie farther out than their troughs; around a level that is not the middle of any range.
    const Settings beside_convection =
      plate + Settings{{"Boundary conditions/Dirichlet", "left: 1"},
                       {"Boundary conditions/Convection", "top: 40, 2"}};
    // Beside convection the eigenvalue is overestimated by a hundredth.
    for (const auto &[settings, shares] :
         {std::make_pair(heated, std::vector<double>{1.007, 1.01, 1.015}),
          std::make_pair(beside_convection, std::vector<double>{1.015, 1.02})})
      for (const double share : shares)
        {
          const Outcome run = step_with_euler(settings, share, nullptr, 1e-3);
          EXPECT_TRUE(run.stopped) << share;
          EXPECT_EQ(run.trip.monitor, "growth") << share;
        }
  }


  TEST(Guards, euler_below_its_limit)
  {
    EXPECT_FALSE(step_with_euler(plate, 0.99, &zero_to_one).trip);
    EXPECT_FALSE(step_with_euler(heated, 0.99).trip);
  }


  TEST(Guards, loads_may_do_what_they_like)
  {
    // Pulses at one node, shorter than it takes to spread, each stronger than all before; a value
    // that grows and falls at once.
    const std::string spot = "if(abs(x - 0.5) + abs(y - 0.5) < 0.01, 1, 0)";
    for (const std::string &source : {"1e4*" + spot + "*if(sin(3e3*t) > 0.9, 1, 0)*exp(20*t)",
                                      spot + "*exp(20*t)",
                                      "1e3*" + spot})
      {
        const Outcome run =
          step_with_euler(plate + Settings{{"Initial and source/Source", source}}, 0.99);
        EXPECT_FALSE(run.trip) << source << ": " << run.trip.found;
      }
    const Outcome driven = step_with_euler(
      plate + Settings{{"Boundary conditions/Dirichlet", "left: exp(20*t)*sin(2e3*t); right: 1"}},
      0.99);
    EXPECT_FALSE(driven.trip) << driven.trip.found;
  }


  TEST(Guards, verlet_above_its_limit)
  {
    const Settings moving{{"Elasticity/Solver", "dynamics"}, {"Domain/Cells", "16, 12"}};
    for (const double share : {0.99, 1.03})
      {
        const Body<2>  body(box<2>() + moving, ModelKind::peridynamics);
        StepperOptions options;
        options.time_step  = share * stable_motion_step(body.op());
        const auto stepper = make_verlet(body.op(), options); // which refuses no step
        Vector     u       = body.values([](const Point<2> &p) {
          return Tensor<1, 2>({1e-3 * p[0] * p[0], 0.});
        });
        Vector     v       = body.vector();
        body.op().distribute(u, 0.);
        const double                start = body.op().energy(u);
        unsigned int                step  = 0;
        std::optional<unsigned int> first_growth;
        Trip                        error;
        for (; step < 2000 && !error; ++step)
          {
            error = trip_of([&] {
              stepper->advance(u, v, step * options.time_step, (step + 1) * options.time_step);
            });
            if (!first_growth && stepper->energy(u, v).kinetic > 30. * start)
              first_growth = step;
          }
        EXPECT_EQ(!!error, share > 1.);
        if (share < 1.)
          continue;
        ASSERT_TRUE(error && first_growth);
        EXPECT_EQ(error.monitor, "energy");
        EXPECT_GT(error.value, error.bound);
        EXPECT_LE(step, *first_growth + soon);
      }
  }


  TEST(Guards, formulas_are_the_cause)
  {
    // A guard trips on what a formula has made: its error becomes the cause.
    const Expression formula("sqrt(0.5 - t)", "'Source' in section 'Initial and source'");
    Trip             trip;
    trip.monitor    = "finite values";
    trip.found      = "the temperature is no finite number any more";
    const auto take = [&](const bool trips) {
      return trip_of([&] {
        with_formulas(MPI_COMM_WORLD, [&] {
          formula.value(Point<2>(0.25, 0.5), 0.75);
          if (trips)
            throw Diverged(trip);
        });
      });
    };
    const Trip error = take(true);
    EXPECT_EQ(error.monitor, "finite values");
    expect_parts(error.cause, {"'Source'", "sqrt(0.5 - t)", "(0.25, 0.5), t = 0.75"});
    EXPECT_EQ(take(false).monitor, "formulas");
  }


  TEST(Guards, the_lowest_of_all_processes)
  {
    const unsigned int rank = this_process(), n = n_processes();
    Trip               own;
    EXPECT_NO_THROW(throw_lowest_if_any(MPI_COMM_WORLD, own)); // nothing has been found
    // Of equal ones that whose place comes first, which is the last process's.
    for (const double y : {0.5, 0.25, 0.75})
      if (rank + 1 == n || y == 0.5)
        keep_lower(own,
                   not_positive("'Conductivity'", -0.125, 0.5625, Point<2>(1. - rank / 8., y)));
    try
      {
        throw_lowest_if_any(MPI_COMM_WORLD, own);
        FAIL();
      }
    catch (const Diverged &error)
      {
        EXPECT_EQ(error.trip.monitor, "formulas");
        EXPECT_EQ(error.trip.value, -0.125);
        EXPECT_EQ(error.trip.place, (std::vector<double>{1. - (n - 1) / 8., 0.25}));
        expect_parts(error.message(), {"'Conductivity'", "-0.125", "0.25), T = 0.5625"});
      }
  }


  TEST(Guards, section)
  {
    EXPECT_EQ(fault("Guards", "Action = warn"), "");
    expect_fault(fault("Guards", "Action = perhaps"), "Guards", "Action", {"stop"});
  }
} // namespace PeriDeal
