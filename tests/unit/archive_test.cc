// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Runs that are interrupted, saved, and taken up again by new objects.

#include <perideal/base/archive.h>
#include <perideal/base/user_error.h>
#include <perideal/solvers/stepper.h>

#include "operator_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;

  namespace
  {
    constexpr double t_end = 0.02;

    const Settings plate{{"Domain/Cells", "12, 9"},
                         {"Domain/Upper corner", "1, 0.75"},
                         {"Peridynamics/Horizon ratio", "2.5"},
                         {"Initial and source/Source", "2 - 7*x*y"}};
    const Settings still{{"Boundary conditions/Dirichlet", "left: 1 + y"}};
    const Settings moving{{"Boundary conditions/Dirichlet", "left: 1 + y + sin(20*t)"},
                          {"Boundary conditions/Flux", "top: 30*t"}};
    const Settings lagged{{"Boundary conditions/Dirichlet", "left: 1 + y + sin(20*t)"},
                          {"Material/Heat capacity", "2 + 0.1*T"}};


    /** Unknowns by their place. */
    NodeKeys keys_of(const Problem<2> &problem)
    {
      NodeKeys keys;
      for (const auto &p : problem.positions)
        keys.push_back((static_cast<std::uint64_t>(std::llround(1e6 * p[0])) << 32) +
                       static_cast<std::uint64_t>(std::llround(1e6 * p[1])));
      return keys;
    }


    /** A run in two spans; the first may be interrupted. */
    struct HeatRun
    {
      HeatRun(const Settings       &settings,
              const ModelKind       model,
              const std::string    &method,
              const StepperOptions &options,
              const MPI_Comm        communicator = MPI_COMM_WORLD)
        : problem(settings, model, communicator)
        , keys(keys_of(problem))
        , stepper(make_stepper(method, problem.op(), options))
        , u(problem.values(bumpy<2>))
      {
        problem.op().distribute(u, 0.);
      }

      void exchange(Archive &archive)
      {
        archive.exchange("u", u, keys);
        stepper->exchange(archive, keys);
      }

      void first(const AfterStep &after_step = {})
      {
        stepper->advance(u, 0., 0.6 * t_end, after_step);
      }

      void second()
      {
        stepper->advance(u, 0.6 * t_end, t_end);
      }

      double entered() const
      {
        return dealii::Utilities::MPI::sum(stepper->entered(), problem.mesh->get_communicator());
      }

      Problem<2>               problem;
      const NodeKeys           keys;
      std::unique_ptr<Stepper> stepper;
      Vector                   u;
    };


    /** How far a run that was resumed ends from one that was not; both relative. */
    void expect_same(const HeatRun &whole, const HeatRun &resumed, const double tolerance)
    {
      EXPECT_LE(difference(whole.problem, whole.u, resumed.problem, resumed.u),
                tolerance * whole.u.linfty_norm());
      EXPECT_NEAR(whole.entered(),
                  resumed.entered(),
                  std::max(tolerance, 1e-13) * std::abs(whole.entered()));
      EXPECT_EQ(whole.stepper->cost().steps, resumed.stepper->cost().steps);
      EXPECT_EQ(whole.stepper->cost().rejected, resumed.stepper->cost().rejected);
    }


    void expect_resumable(const Settings    &settings,
                          const ModelKind    model,
                          const std::string &method,
                          const double       time_step,
                          const double       tolerance,
                          const double       tolerance_alone)
    {
      SCOPED_TRACE(method + (time_step > 0. ? ", fixed steps, " : ", ") + to_string(model));
      StepperOptions options;
      options.time_step        = time_step;
      options.solver_tolerance = 1e-14;

      HeatRun whole(settings, model, method, options);
      whole.first();
      whole.second();

      MemoryArchive saved(MPI_COMM_WORLD);
      {
        HeatRun            begun(settings, model, method, options);
        const unsigned int wanted  = time_step > 0. ? 3 : 1; // steps of its own are longer
        unsigned int       n_steps = 0;
        begun.first([&](const double t) {
          if (++n_steps != wanted)
            return;
          EXPECT_LT(t, 0.6 * t_end);
          begun.exchange(saved);
        });
        ASSERT_GE(n_steps, wanted);
      }
      const auto resume = [&](const MPI_Comm communicator, const double allowed) {
        HeatRun       resumed(settings, model, method, options, communicator);
        MemoryArchive archive(saved, communicator);
        resumed.exchange(archive);
        ASSERT_TRUE(resumed.stepper->is_inside_span());
        resumed.stepper->go_on(resumed.u);
        resumed.second();
        expect_same(whole, resumed, allowed);
      };
      resume(MPI_COMM_WORLD, tolerance);
      resume(MPI_COMM_SELF, tolerance_alone);
    }
  } // namespace


  TEST(Archive, explicit_steppers_go_on_to_the_last_bit)
  {
    constexpr auto bonds = ModelKind::peridynamics;
    for (const std::string method : {"euler", "rk4"})
      {
        expect_resumable(plate + moving, bonds, method, 2e-4, 0., 0.);
        expect_resumable(plate + lagged, bonds, method, -1., 0., 1e-10);
      }
    expect_resumable(plate + moving, bonds, "rkc2", 1e-3, 0., 1e-10);
    expect_resumable(plate + moving, bonds, "rkc2", -1., 0., 1e-10);
    expect_resumable(plate + lagged, bonds, "rkc2", -1., 0., 1e-10);
    expect_resumable(plate + still, bonds, "chebyshev", 1e-3, 0., 0.);
    expect_resumable(plate + moving, ModelKind::finite_elements, "rkc2", -1., 0., 1e-10);
  }


  TEST(Archive, implicit_steppers_go_on)
  {
    for (const std::string method : {"sdirk2", "bdf2", "crank nicolson"})
      {
        expect_resumable(plate + moving, ModelKind::peridynamics, method, 2e-3, 1e-12, 1e-10);
        expect_resumable(plate + moving, ModelKind::finite_elements, method, -1., 1e-12, 1e-10);
      }
    expect_resumable(plate + lagged, ModelKind::peridynamics, "bdf2", 1e-3, 1e-12, 1e-10);
  }


  TEST(Archive, refuses_what_is_not_there)
  {
    StepperOptions options;
    options.time_step = 2e-4;
    HeatRun       run(plate + moving, ModelKind::peridynamics, "euler", options);
    MemoryArchive saved(MPI_COMM_WORLD);
    run.exchange(saved);

    MemoryArchive archive(saved, MPI_COMM_WORLD);
    double        other = 0.;
    EXPECT_THROW(archive.exchange("nothing", other), UserError);

    const Settings finer = plate + Settings{{"Domain/Cells", "16, 12"}};
    HeatRun        larger(finer + moving, ModelKind::peridynamics, "euler", options);
    EXPECT_THROW(larger.exchange(archive), UserError);
  }
} // namespace PeriDeal
