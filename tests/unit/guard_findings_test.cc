// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// What solvers find wrong, and a run goes on from where it only warns.

#include <perideal/problems/result_record.h>
#include <perideal/solvers/motion_stepper.h>
#include <perideal/solvers/stepper.h>

#include <cmath>
#include <limits>

#include "elastic_test_tools.h"
#include "scene_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using namespace SceneTests;
  using dealii::Point;
  using dealii::Tensor;

  TEST(GuardFindings, wait_or_end_the_run)
  {
    const Diverged one("one", "energy", 2., 1., 0.5), other("other", "inversion", 1., 0., 0.6);
    Findings       ends;
    EXPECT_THROW(ends.add(one, 7), Diverged);
    EXPECT_FALSE(ends.take());
    Findings waits;
    waits.let_wait();
    for (unsigned int k = 0; k < 3; ++k)
      waits.add(one, 7 + k);
    waits.add(other, 20);
    EXPECT_TRUE(waits.has("energy"));
    EXPECT_FALSE(waits.has("time step"));
    const Trip first = waits.take(), second = waits.take();
    EXPECT_EQ(first.monitor, "energy");
    EXPECT_EQ(first.n_steps, 7u);
    EXPECT_DOUBLE_EQ(first.time, 0.5);
    EXPECT_EQ(second.monitor, "inversion");
    EXPECT_FALSE(waits.take());
    waits.add(one, 30);
    EXPECT_FALSE(waits.take()); // it has been told
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(waits.add(Diverged("none", "finite values", none, none), 40), Diverged);
  }


  TEST(GuardFindings, another_solver_goes_on)
  {
    const Diverged one("one", "time step", 2., 1.), other("other", "energy", 1., 0.);
    Findings       before, after;
    before.let_wait();
    after.let_wait();
    before.add(one, 7);
    after.add(other, 8);
    after.carry_over(before);
    after.add(one, 9);
    EXPECT_EQ(after.take().monitor, "time step"); // the older one first
    EXPECT_EQ(after.take().monitor, "energy");
    EXPECT_FALSE(after.take());
  }


  TEST(GuardFindings, what_has_been_told_is_kept)
  {
    ResultRecord record, resumed, of_earlier;
    record.notes                            = {"a note"};
    record.totals                           = "a row";
    record.warned["peridynamics"]["energy"] = true;
    MemoryArchive saved(MPI_COMM_WORLD), before(MPI_COMM_WORLD);
    record.exchange(saved);
    MemoryArchive loaded(saved, MPI_COMM_WORLD);
    resumed.exchange(loaded);
    EXPECT_TRUE(resumed.warned["peridynamics"].contains("energy"));
    EXPECT_FALSE(resumed.warned["peridynamics"].contains("inversion"));
    // From a checkpoint that does not have that.
    std::string text = R"([["a note"], [], {}, {}, {}, {}, {}, "a row"])";
    before.exchange("record", text);
    MemoryArchive old(before, MPI_COMM_WORLD);
    of_earlier.exchange(old);
    EXPECT_TRUE(of_earlier.warned.empty());
    for (const ResultRecord *const one : {&resumed, &of_earlier})
      {
        EXPECT_EQ(one->notes, record.notes);
        EXPECT_EQ(one->totals, record.totals);
      }
  }


  TEST(GuardFindings, verlet_goes_on_until_nothing_is_finite)
  {
    const Body<2>  body(box<2>() +
                         Settings{{"Elasticity/Solver", "dynamics"}, {"Domain/Cells", "16, 12"}},
                       ModelKind::peridynamics);
    StepperOptions options;
    options.time_step  = 1.03 * stable_motion_step(body.op());
    const auto stepper = make_verlet(body.op(), options); // which refuses no step
    stepper->findings().let_wait();
    Vector u = body.values([](const Point<2> &p) {
      return Tensor<1, 2>({1e-3 * p[0] * p[0], 0.});
    });
    Vector v = body.vector();
    body.op().distribute(u, 0.);
    const double dt = options.time_step;
    Trip         told;
    unsigned int step = 0;
    std::string  end;
    for (; step < 5000 && end.empty(); ++step)
      {
        end = trip_of([&] { stepper->advance(u, v, step * dt, (step + 1) * dt); }).monitor;
        if (const Trip found = stepper->findings().take())
          {
            EXPECT_FALSE(told);
            told = found;
          }
      }
    EXPECT_EQ(told.monitor, "energy");
    EXPECT_EQ(end, "finite values");
    EXPECT_GT(step, told.n_steps + 100u);
  }


  TEST(GuardFindings, euler_goes_on_above_its_limit)
  {
    const OperatorTests::Problem<2> problem(
      {{"Domain/Cells", "12, 12"},
       {"Peridynamics/Boundary treatment", "fictitious mirror"},
       {"Boundary conditions/Dirichlet", "left: 1; right: 0"},
       {"Material/Conductivity", "1 + 2*T"}});
    StepperOptions options;
    problem.op().take_material_at(problem.values([](const auto &) { return 0.; }), 0.);
    options.time_step = 0.95 * stable_step("euler", problem.op().spectrum().sharp);
    for (const bool waits : {false, true})
      {
        const auto stepper = make_euler(problem.op(), options);
        if (waits)
          stepper->findings().let_wait();
        Vector u = problem.values([](const auto &) { return 1.; });
        problem.op().distribute(u, 0.);
        const auto advance = [&] { stepper->advance(u, 0., 3. * options.time_step); };
        if (!waits)
          {
            EXPECT_THROW(advance(), Diverged);
            continue;
          }
        EXPECT_NO_THROW(advance());
        const Trip found = stepper->findings().take();
        EXPECT_EQ(found.monitor, "time step");
        EXPECT_DOUBLE_EQ(found.time, 0.);
        EXPECT_FALSE(stepper->findings().take());
        EXPECT_EQ(stepper->cost().steps, 3u);
      }
  }
} // namespace PeriDeal
