// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// The balance of heat since the start: what steppers say has entered, against what the body holds.

#include <perideal/operators/diffusion/heat_content.h>
#include <perideal/solvers/stepper.h>

#include "operator_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using dealii::Point;

  namespace
  {
    const Settings plate{{"Domain/Cells", "16, 12"},
                         {"Domain/Upper corner", "1, 0.75"},
                         {"Peridynamics/Horizon ratio", "2.5"},
                         {"Material/Heat capacity", "2"},
                         {"Initial and source/Source", "2 - 7*x*y"}};
    const Settings sides{{"Boundary conditions/Dirichlet", "left: 1 + y"},
                         {"Boundary conditions/Flux", "top: 3*x"},
                         {"Boundary conditions/Convection", "right: 4 + y, 2"}};
    const Settings moving{{"Boundary conditions/Dirichlet", "left: 1 + y + sin(20*t)"},
                          {"Boundary conditions/Flux", "top: 30*t"}};
    const Settings closed{{"Material/Heat capacity", "1 + T"}, {"Initial and source/Source", "0"}};

    constexpr double t_end = 0.05;


    struct Account
    {
      double entered, stored, size; // size: the content at the end, or what entered
      double lost() const
      {
        return std::abs(entered - stored) / size;
      }
    };


    template <int dim>
    Account advanced(const Problem<dim>   &problem,
                     const std::string    &stepper,
                     const StepperOptions &options,
                     const unsigned int    n_calls = 2)
    {
      Vector u = problem.values(bumpy<dim>);
      problem.op().distribute(u, 0.);
      problem.op().take_material_at(u, 0.);
      problem.op().distribute(u, 0.);
      const double before = problem.op().balance(u, 0., false).content;
      const auto   method = make_stepper(stepper, problem.op(), options);
      for (unsigned int k = 0; k < n_calls; ++k)
        method->advance(u, t_end * k / n_calls, t_end * (k + 1) / n_calls);
      const double after   = problem.op().balance(u, t_end, false).content;
      const double entered = sum_of_all(method->entered());
      return {entered, after - before, std::max(std::abs(after), std::abs(entered))};
    }


    StepperOptions with_step(const double step)
    {
      StepperOptions options;
      options.time_step        = step;
      options.solver_tolerance = 1e-13;
      return options;
    }
  } // namespace


  TEST(HeatSteps, every_stepper_keeps_its_balance)
  {
    const std::vector<std::pair<std::string, double>> methods{{"euler", 1e-4},
                                                              {"rk4", -1.},
                                                              {"rkc2", t_end / 10},
                                                              {"rkc2", -1.},
                                                              {"chebyshev", -1.},
                                                              {"sdirk2", -1.},
                                                              {"bdf2", t_end / 20},
                                                              {"bdf2", -1.},
                                                              {"crank nicolson", t_end / 20}};
    for (const ModelKind model : {ModelKind::finite_elements, ModelKind::peridynamics})
      for (const auto &[stepper, step] : methods)
        for (const bool changes : {false, true})
          {
            if (changes && stepper == "chebyshev")
              continue; // refuses loads that change
            const Problem<2> problem(plate + sides + (changes ? moving : Settings()), model);
            const Account    account = advanced(problem, stepper, with_step(step));
            EXPECT_GT(std::abs(account.entered), 0.01);
            // The expansion of chebyshev ends where the rest is below its tolerance.
            EXPECT_LE(account.lost(), stepper == "chebyshev" ? 1e-5 : 1e-11)
              << to_string(model) << ", " << stepper << ", " << step << ", " << changes;
          }
  }


  TEST(HeatSteps, consistent_capacity_and_fictitious_nodes)
  {
    const Problem<2> consistent(plate + sides + moving +
                                  Settings{{"Finite elements/Capacity", "consistent"}},
                                ModelKind::finite_elements);
    for (const std::string stepper : {"sdirk2", "bdf2", "crank nicolson"})
      EXPECT_LE(advanced(consistent, stepper, with_step(t_end / 20)).lost(), 1e-11) << stepper;
    const Problem<2> mirrored(plate + sides + moving +
                                Settings{{"Peridynamics/Boundary treatment", "fictitious mirror"}},
                              ModelKind::peridynamics);
    for (const std::string stepper : {"rk4", "rkc2", "sdirk2"})
      EXPECT_LE(advanced(mirrored, stepper, with_step(-1.)).lost(), 1e-11) << stepper;
  }


  TEST(HeatSteps, closed_body_of_varying_capacity_keeps_its_heat)
  {
    // At the default tolerance, and by fixed steps of a tenth of the time, whose correction leaves
    // a little more.
    for (const ModelKind model : {ModelKind::finite_elements, ModelKind::peridynamics})
      {
        const Problem<2> problem(plate + closed, model);
        for (const auto &[stepper, step] :
             std::vector<std::pair<std::string, double>>{{"rkc2", -1.},
                                                         {"rkc2", t_end / 10},
                                                         {"euler", -1.},
                                                         {"rk4", -1.},
                                                         {"sdirk2", -1.},
                                                         {"bdf2", -1.},
                                                         {"crank nicolson", -1.}})
          {
            const Account account = advanced(problem, stepper, with_step(step));
            EXPECT_EQ(account.entered, 0.) << stepper;
            EXPECT_LE(account.lost(), step > 0. ? 5e-6 : 1e-6)
              << to_string(model) << ", " << stepper << ", " << step;
          }
      }
  }


  TEST(HeatSteps, open_body_of_varying_capacity)
  {
    const Settings varying{{"Material/Heat capacity", "1 + T + T^2/4"},
                           {"Material/Conductivity", "1 + T/2"}};
    for (const ModelKind model : {ModelKind::finite_elements, ModelKind::peridynamics})
      for (const std::string stepper : {"rkc2", "sdirk2"})
        {
          const Problem<2> problem(plate + sides + moving + varying, model);
          const Account    account = advanced(problem, stepper, with_step(-1.));
          EXPECT_GT(std::abs(account.entered), 0.01);
          EXPECT_LE(account.lost(), 1e-5) << to_string(model) << ", " << stepper;
        }
  }


  TEST(HeatSteps, content_of_a_capacity_with_a_peak)
  {
    // Melting: a peak of area 3 between 0.9 and 1.1 on top of 1. One Gauss rule over the whole
    // range misses most of it.
    const Problem<1> problem(
      {{"Domain/Cells", "4"}, {"Material/Heat capacity", "1 + 30*max(0, 1 - 10*abs(T - 1))"}});
    EXPECT_NEAR(heat_content(problem.scene.material, Point<1>(0.5), 2.), 5., 1e-2);
    EXPECT_NEAR(heat_content(problem.scene.material, Point<1>(0.5), -1.), -1., 1e-12);
  }
} // namespace PeriDeal
