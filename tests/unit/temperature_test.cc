// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Conductivity and heat capacity that depend on the temperature.


#include <perideal/solvers/stepper.h>

#include "operator_test_tools.h"
#include "scene_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using dealii::Point;

  namespace
  {
    const Settings wall{{"Domain/Cells", "20, 8"},
                        {"Domain/Upper corner", "1, 0.4"},
                        {"Material/Conductivity", "1 + T"},
                        {"Boundary conditions/Dirichlet", "left: 0; right: 1"}};
    const Settings mirrored{{"Peridynamics/Boundary treatment", "fictitious mirror"},
                            {"Boundary conditions/Symmetry", "bottom, top"}};


    template <int dim>
    Vector advanced(const Problem<dim> &problem,
                    const std::string  &stepper,
                    const double        step,
                    const double        tolerance = 1e-6,
                    const double        end       = 0.05)
    {
      StepperOptions options;
      options.time_step        = step;
      options.tolerance        = tolerance;
      options.solver_tolerance = 1e-13;
      Vector u                 = problem.values([](const Point<dim> &p) { return p[0] * p[0]; });
      problem.op().distribute(u, 0.);
      make_stepper(stepper, problem.op(), options)->advance(u, 0., end);
      return u;
    }
  } // namespace


  TEST(Temperature, kirchhoff_transformation_of_a_wall)
  {
    // theta = T + T^2/2 is linear in the steady state; bonds and elements with the mean of both
    // ends carry exactly its differences.
    for (const ModelKind model : {ModelKind::peridynamics, ModelKind::finite_elements})
      {
        const Problem<2> problem(wall + mirrored, model);
        const Vector     u = problem.steady(), exact = problem.values([](const Point<2> &p) {
          return std::sqrt(1. + 3. * p[0]) - 1.;
        });
        // Elements are exact at their vertices; beyond a side the mirror keeps T, not theta,
        // linear: measured 5e-4.
        EXPECT_LE(largest_difference(u, exact), model == ModelKind::finite_elements ? 1e-10 : 8e-4);
        const auto balance = problem.op().balance(u, 0., true);
        EXPECT_NEAR(balance.sides.at("right"), 1.5 * 0.4, 5e-3);
        EXPECT_NEAR(balance.imbalance(), 0., 1e-10);
      }
  }


  TEST(Temperature, orders_of_the_steppers)
  {
    const Settings both = wall + mirrored +
                          Settings{{"Material/Heat capacity", "1 + T/2"},
                                   {"Domain/Cells", "20, 4"},
                                   {"Domain/Upper corner", "1, 0.2"}};
    for (const ModelKind model : {ModelKind::peridynamics, ModelKind::finite_elements})
      {
        const Problem<2> problem(both, model);
        const Vector     exact = advanced(problem, "crank nicolson", 0.05 / 128);
        // Lagged: first order, whatever the method is otherwise. Iterated: their own.
        for (const auto &[stepper, order] :
             std::vector<std::pair<std::string, double>>{{"euler", 1.},
                                                         {"rk4", 1.},
                                                         {"rkc2", 1.},
                                                         {"sdirk2", 2.},
                                                         {"bdf2", 2.},
                                                         {"crank nicolson", 2.}})
          {
            const bool   is_explicit = order == 1. && stepper != "rkc2";
            const double step        = is_explicit ? 1.2e-4 : 0.05 / 16;
            const double coarse      = largest_difference(advanced(problem, stepper, step), exact),
                         fine = largest_difference(advanced(problem, stepper, 0.5 * step), exact);
            EXPECT_NEAR(std::log2(coarse / fine), order, 0.25)
              << to_string(model) << ", " << stepper << ": " << coarse << ", " << fine;
          }
        // Adaptive steps see the lag in their error estimate.
        EXPECT_LE(largest_difference(advanced(problem, "rkc2", -1., 1e-5), exact), 2e-4);
        EXPECT_LE(largest_difference(advanced(problem, "sdirk2", -1., 1e-5), exact), 1e-4);
      }
  }


  TEST(Temperature, flows_are_those_of_the_last_temperatures)
  {
    for (const ModelKind model : {ModelKind::peridynamics, ModelKind::finite_elements})
      for (const auto &[stepper, step] :
           std::vector<std::pair<std::string, double>>{{"euler", 1.2e-4},
                                                       {"rkc2", 0.05 / 8},
                                                       {"rkc2", -1.}})
        {
          const Problem<2> problem(wall, model);
          const Vector     u    = advanced(problem, stepper, step);
          const double     heat = problem.op().balance(u, 0.05, false).sides.at("right");
          problem.op().take_material_at(u, 0.);
          EXPECT_NEAR(problem.op().balance(u, 0.05, false).sides.at("right"),
                      heat,
                      1e-13 * std::abs(heat))
            << to_string(model) << ", " << stepper;
        }
  }


  TEST(Temperature, content_is_the_integral_of_the_capacity)
  {
    for (const ModelKind model : {ModelKind::peridynamics, ModelKind::finite_elements})
      {
        const Problem<2> problem(wall + Settings{{"Material/Heat capacity", "1 + T/2"}}, model);
        Vector           u = problem.values([](const Point<2> &) { return 2.; });
        EXPECT_NEAR(problem.op().balance(u, 0., false).content, 0.4 * (2. + 1.), 1e-12);
      }
  }


  TEST(Temperature, cracks_and_slaves_follow)
  {
    // An operator that takes the material at some temperatures is that of a scene which starts with
    // them.
    const auto     temperature = [](const Point<2> &p) { return 0.5 * p[0] + p[0] * p[1]; };
    const Settings crack{{"Cracks/Segments", "0.31,0.13 ; 0.72,0.29"},
                         {"Boundary conditions/Dirichlet", "left: 0"}},
      contact{{"Cracks/Contact conductance", "3"}},
      scaled{{"Peridynamics/Surface correction", "crack scaling"}},
      slaves{{"Boundary conditions/Flux", "right: 2"},
             {"Peridynamics/Flux treatment", "extrapolation"}};
    for (const ModelKind model : {ModelKind::peridynamics, ModelKind::finite_elements})
      for (const Settings &more : {contact, scaled, contact + scaled, contact + slaves})
        {
          const Problem<2> cold(wall + crack + more, model),
            warm(wall + crack + more +
                   Settings{{"Initial and source/Initial value", "0.5*x + x*y"}},
                 model);
          Vector u = cold.values(temperature);
          cold.op().take_material_at(u, 0.);
          Vector v = warm.values(temperature);
          cold.op().distribute(u, 0.);
          warm.op().distribute(v, 0.);
          EXPECT_LE(largest_difference(u, v), 1e-13);
          EXPECT_LE(largest_difference(cold.residual(u), warm.residual(v)),
                    1e-13 * warm.op().diagonal().linfty_norm());
          EXPECT_LE(relative_difference(cold.op().diagonal(), warm.op().diagonal()), 1e-13);
        }
  }


  TEST(Temperature, same_on_every_number_of_processes)
  {
    for (const ModelKind model : {ModelKind::peridynamics, ModelKind::finite_elements})
      for (const std::string treatment : {"none", "fictitious mirror"})
        {
          const Settings   both = wall + Settings{{"Material/Heat capacity", "1 + T/2"},
                                                {"Peridynamics/Boundary treatment", treatment}};
          const Problem<2> all(both, model), alone(both, model, MPI_COMM_SELF);
          const auto       gap = [&](const std::string &stepper, const double step) {
            return difference(all,
                              advanced(all, stepper, step, 1e-6, 0.01),
                              alone,
                              advanced(alone, stepper, step, 1e-6, 0.01));
          };
          EXPECT_LE(gap("euler", 1.2e-4), model == ModelKind::peridynamics ? 0. : 1e-12);
          EXPECT_LE(gap("sdirk2", 0.05 / 32), 1e-9);
        }
  }


  TEST(Temperature, mistakes)
  {
    using SceneTests::message_of;
    const auto fault = [](const Settings &more) {
      return message_of([&] {
        const Problem<2> problem(wall + more);
        advanced(problem, "rkc2", -1.);
      });
    };
    EXPECT_EQ(fault({}), "");
    SceneTests::expect_parts(fault({{"Material/Interface rule", "harmonic"}}),
                             {"'Interface rule' in section 'Material'", "arithmetic"});
    SceneTests::expect_parts(
      fault({{"Material/Conductivity", "0.5 - T"}, {"Initial and source/Initial value", "0.1"}}),
      {"'Conductivity' in section 'Material'", "T =", "positive"});
    SceneTests::expect_parts(fault({{"Material/Heat capacity", "0.5 - T"}}),
                             {"'Heat capacity'", "positive"});
    SceneTests::expect_parts(fault({{"Material/Saturated concentration", "T"}}),
                             {"'Saturated concentration'", "'T'"});
    const Problem<2> problem(wall);
    SceneTests::expect_error([&] { make_stepper("chebyshev", problem.op(), StepperOptions()); },
                             {"'Stepper = chebyshev'", "temperature"});
  }
} // namespace PeriDeal
