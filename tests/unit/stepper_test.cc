// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/numbers.h>

#include <perideal/solvers/stepper.h>

#include "operator_test_tools.h"
#include "scene_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using dealii::Point;

  namespace
  {
    constexpr double pi = dealii::numbers::PI;

    /** Order that a method should show. */
    const std::vector<std::pair<std::string, double>> methods = {{"euler", 1.},
                                                                 {"rk4", 4.},
                                                                 {"rkc2", 2.},
                                                                 {"crank nicolson", 2.},
                                                                 {"bdf2", 2.},
                                                                 {"sdirk2", 2.}};


    StepperOptions options_with(const double time_step, const double tolerance = 1e-4)
    {
      StepperOptions options;
      options.time_step        = time_step;
      options.tolerance        = tolerance;
      options.solver_tolerance = 1e-13;
      return options;
    }


    /** The exact solution of a semi-discrete problem. */
    using Solution = std::function<double(const Point<2> &, const double)>;


    /** Relative error at the end; steps of dt, in the given number of calls. */
    double error_at_end(const Problem<2>     &problem,
                        const Solution       &exact,
                        const std::string    &method,
                        const StepperOptions &options,
                        const double          t_end,
                        const unsigned int    n_calls = 1)
    {
      auto   stepper = make_stepper(method, problem.op(), options);
      Vector u       = problem.values([&](const auto &p) { return exact(p, 0.); });
      problem.op().distribute(u, 0.);
      for (unsigned int k = 0; k < n_calls; ++k)
        stepper->advance(u, t_end * k / n_calls, t_end * (k + 1) / n_calls);
      const Vector end = problem.values([&](const auto &p) { return exact(p, t_end); });
      return relative_difference(u, end);
    }


    double order(const Problem<2>  &problem,
                 const Solution    &exact,
                 const std::string &method,
                 const double       dt,
                 const double       t_end)
    {
      const double coarse = error_at_end(problem, exact, method, options_with(dt), t_end),
                   fine   = error_at_end(problem, exact, method, options_with(0.5 * dt), t_end);
      EXPECT_GT(fine, 1e-13) << method << ": round-off hides the order";
      return std::log2(coarse / fine);
    }


    /** Product of sines between mirrors: decays with one rate, exactly. */
    struct Harmonic
    {
      explicit Harmonic(const unsigned int cells = 10)
        : problem(
            Settings{{"Domain/Cells", std::to_string(cells) + "," + std::to_string(cells)},
                     {"Domain/Nodes", "cell centers"},
                     {"Peridynamics/Horizon ratio", "3"},
                     {"Peridynamics/Boundary treatment", "fictitious mirror"},
                     {"Boundary conditions/Dirichlet", "left: 0 ; right: 0 ; bottom: 0 ; top: 0"}})
      {
        for (const auto &member : bonds_of(problem.op()).diffusion_bonds().weights().members())
          lambda += member.weight / (cells * cells) *
                    (1. - std::cos(pi * member.offset[0] / cells) *
                            std::cos(pi * member.offset[1] / cells));
      }

      Solution solution() const
      {
        return [this](const Point<2> &p, const double t) {
          return std::sin(pi * p[0]) * std::sin(pi * p[1]) * std::exp(-lambda * t);
        };
      }

      Problem<2> problem;
      double     lambda = 0.;
    };


    /**
     * T = (1 + x) cos(3 t), prescribed on four rows at either end, with mirrors at the top and
     * bottom: K of a linear field is zero in full families, so that the source has nothing but its
     * rate of change to provide.
     */
    Settings driven()
    {
      return {{"Domain/Cells", "10, 10"},
              {"Boundary conditions/Dirichlet", "left: (1 + x)*cos(3*t) ; right: (1 + x)*cos(3*t)"},
              {"Boundary conditions/Symmetry", "bottom, top"},
              {"Peridynamics/Boundary treatment", "layer"},
              {"Peridynamics/Layer rows", "4"},
              {"Initial and source/Source", "-3*(1 + x)*sin(3*t)"}};
    }
  } // namespace


  TEST(Steppers, orders_on_a_harmonic)
  {
    const Harmonic harmonic;
    const double   stable = 2. / harmonic.problem.op().spectrum().sharp;
    for (const auto &[name, expected] : methods)
      {
        const bool   is_fast = name == "euler" || name == "rk4";
        const double dt      = is_fast ? 0.6 * stable : 0.005;
        EXPECT_NEAR(order(harmonic.problem, harmonic.solution(), name, dt, 16. * dt),
                    expected,
                    0.15)
          << name;
      }
  }


  TEST(Steppers, orders_with_loads_and_values_in_time)
  {
    const Problem<2> problem(driven());
    EXPECT_EQ(choose_stepper(problem.op()), "rkc2");
    const Solution exact = [](const Point<2> &p, const double t) {
      return (1. + p[0]) * std::cos(3. * t);
    };
    const double stable = 2. / problem.op().spectrum().sharp;
    for (const auto &[name, expected] : methods)
      {
        // The error of rk4 is lost in round-off at any stable step; prescribed values in time
        // reduce its order to 2.
        if (name == "rk4")
          continue;
        // RKC2's number of stages, and with it its error's constant, changes with the step: two
        // stages from here on.
        const double dt = name == "euler" ? 0.6 * stable : name == "rkc2" ? 0.003 : 0.0125;
        EXPECT_NEAR(order(problem, exact, name, dt, name == "euler" ? 16. * dt : 0.4),
                    expected,
                    0.15)
          << name;
      }
  }


  TEST(Steppers, orders_with_consistent_capacity)
  {
    // Q1 on a line of cells: cos(pi x) is a discrete harmonic of the consistent system, too, and so
    // is its product with a constant.
    const unsigned int n = 16;
    const Problem<2>   problem(
      {{"Domain/Cells", "16, 4"}, {"Finite elements/Capacity", "consistent"}},
      ModelKind::finite_elements);
    EXPECT_FALSE(problem.op().capacity_is_diagonal());
    EXPECT_EQ(choose_stepper(problem.op()), "sdirk2");
    const double   c = std::cos(pi / n), lambda = 6. * n * n * (1. - c) / (2. + c);
    const Solution exact = [&](const Point<2> &p, const double t) {
      return std::cos(pi * p[0]) * std::exp(-lambda * t);
    };
    for (const std::string name : {"crank nicolson", "bdf2", "sdirk2"})
      EXPECT_NEAR(order(problem, exact, name, 0.005, 0.08), 2., 0.15) << name;
    for (const std::string name : {"euler", "rk4", "rkc2", "chebyshev"})
      SceneTests::expect_error([&] { make_stepper(name, problem.op(), options_with(-1.)); },
                               {name, "'Capacity = lumped'", "sdirk2"});
  }


  TEST(Steppers, consistent_capacity_with_values_in_time)
  {
    // T = (1 + x) cos(3 t) is in the space of elements: only the error in time is left.
    const Problem<2> problem(
      {{"Domain/Cells", "8, 8"},
       {"Finite elements/Capacity", "consistent"},
       {"Boundary conditions/Dirichlet", "left: cos(3*t) ; right: 2*cos(3*t)"},
       {"Initial and source/Source", "-3*(1 + x)*sin(3*t)"}},
      ModelKind::finite_elements);
    const Solution exact = [](const Point<2> &p, const double t) {
      return (1. + p[0]) * std::cos(3. * t);
    };
    for (const std::string name : {"crank nicolson", "bdf2", "sdirk2"})
      EXPECT_NEAR(order(problem, exact, name, 0.0125, 0.4), 2., 0.15) << name;
  }


  TEST(Steppers, land_exactly_and_in_pieces)
  {
    const Harmonic harmonic(8);
    const double   dt = 0.7 * 2. / harmonic.problem.op().spectrum().sharp;
    for (const auto &[name, order] : methods)
      {
        // A multiple of the step in one call or in eight: the same steps. One-step methods: the
        // same numbers.
        auto whole = make_stepper(name, harmonic.problem.op(), options_with(dt)),
             parts = make_stepper(name, harmonic.problem.op(), options_with(dt));
        Vector u =
          harmonic.problem.values([&](const auto &p) { return harmonic.solution()(p, 0.); });
        Vector v(u);
        whole->advance(u, 0., 8. * dt);
        for (unsigned int k = 0; k < 8; ++k)
          parts->advance(v, k * dt, (k + 1) * dt);
        EXPECT_EQ(whole->cost().steps, 8u) << name;
        EXPECT_EQ(parts->cost().steps, 8u) << name;
        EXPECT_LT(largest_difference(u, v), 1e-12 * u.linfty_norm()) << name;
        // Spans that are no multiple: lands all the same.
        const double span = 3.37 * dt;
        EXPECT_LT(
          error_at_end(harmonic.problem, harmonic.solution(), name, options_with(0.02 * dt), span),
          0.01)
          << name;
      }
    // Exponentials and adaptive methods: pieces agree within the tolerance.
    for (const std::string name : {"chebyshev", "rkc2", "sdirk2", "bdf2", "crank nicolson"})
      for (const unsigned int n_calls : {1, 7})
        EXPECT_LT(error_at_end(harmonic.problem,
                               harmonic.solution(),
                               name,
                               options_with(-1., 1e-5),
                               0.1,
                               n_calls),
                  1e-4)
          << name << ", " << n_calls << " calls";
  }


  TEST(Steppers, adaptive_ones_reach_their_tolerance)
  {
    const Harmonic harmonic;
    for (const std::string name : {"rkc2", "sdirk2", "bdf2", "crank nicolson"})
      for (const double tolerance : {1e-3, 1e-4, 1e-5})
        {
          auto   stepper = make_stepper(name, harmonic.problem.op(), options_with(-1., tolerance));
          Vector u =
            harmonic.problem.values([&](const auto &p) { return harmonic.solution()(p, 0.); });
          stepper->advance(u, 0., 0.05);
          const Vector end =
            harmonic.problem.values([&](const auto &p) { return harmonic.solution()(p, 0.05); });
          EXPECT_LT(relative_difference(u, end), 10. * tolerance) << name;
          EXPECT_GT(stepper->cost().steps, 2u);
          EXPECT_LT(stepper->cost().steps, 3000u) << name << " at " << tolerance;
        }
  }


  TEST(Steppers, adaptive_ones_take_moving_prescribed_values_in_their_stride)
  {
    // A ramp on one side: smooth inside, so steps must not shrink because the prescribed nodes
    // move.
    const Problem<2> problem({{"Domain/Cells", "16, 4"},
                              {"Peridynamics/Horizon", "0.5"},
                              {"Boundary conditions/Dirichlet", "left: 1 + t ; right: 1 + t"},
                              {"Initial and source/Initial value", "1"}});
    auto             reference = make_stepper("rk4", problem.op(), options_with(-1.));
    Vector           exact     = problem.values([](const auto &) { return 1.; });
    reference->advance(exact, 0., 0.5);
    for (const std::string name : {"rkc2", "sdirk2", "bdf2", "crank nicolson"})
      {
        auto   stepper = make_stepper(name, problem.op(), options_with(-1., 1e-4));
        Vector u       = problem.values([](const auto &) { return 1.; });
        stepper->advance(u, 0., 0.5);
        EXPECT_LT(largest_difference(u, exact), 1e-3) << name;
        EXPECT_LT(stepper->cost().steps, 100u) << name;
      }
  }


  TEST(Steppers, adaptive_ones_are_stable_on_a_discontinuous_start)
  {
    // Initially 1 everywhere against zero on the sides, with and without a crack.
    for (const Settings &crack :
         {Settings(), Settings{{"Cracks/Segments", "0.23,0.51 ; 0.77,0.53"}}})
      {
        const Problem<2> problem(crack +
                                 Settings{{"Domain/Cells", "20, 20"},
                                          {"Boundary conditions/Dirichlet", "left: 0; top: 0"},
                                          {"Initial and source/Initial value", "1"}});
        Vector           exact = problem.values([](const auto &) { return 1.; });
        problem.op().distribute(exact, 0.);
        const Vector start(exact);
        auto         reference = make_stepper("chebyshev", problem.op(), options_with(-1., 1e-12));
        reference->advance(exact, 0., 0.05);
        for (const std::string name : {"rkc2", "sdirk2", "bdf2", "crank nicolson"})
          {
            auto   stepper = make_stepper(name, problem.op(), options_with(-1., 1e-3));
            Vector u(start);
            stepper->advance(u, 0., 0.05);
            EXPECT_LT(largest_difference(u, exact), 1e-2) << name;
            EXPECT_LT(u.linfty_norm(), 1.001) << name;
          }
      }
  }


  TEST(Steppers, chebyshev_is_exact_for_every_kernel)
  {
    const auto check = [](const auto &problem, const std::string &what) {
      // Against RK4 far below its limit, or better: twice half the span is the whole span, and
      // lattice harmonics.
      const auto f = [](const auto &p) {
        double s = 1.;
        for (unsigned int d = 0; d < std::decay_t<decltype(p)>::dimension; ++d)
          s *= std::sin(pi * p[d]);
        return s;
      };
      Vector u = problem.values(f), weighted = problem.vector();
      problem.op().apply_capacity(weighted, u);
      const double lambda  = (problem.product(u) * u) / (weighted * u);
      auto         stepper = make_stepper("chebyshev", problem.op(), options_with(-1., 1e-12));
      const Vector start(u);
      stepper->advance(u, 0., 0.1);
      u.add(-std::exp(-0.1 * lambda), start);
      EXPECT_LT(u.linfty_norm() / std::exp(-0.1 * lambda), 1e-10) << what;
    };
    const auto settings = [](const unsigned int dim, const char *kernel, const unsigned int n) {
      const char *const cells[] = {"", "12", "12,12", "8,8,8"};
      std::string       sides;
      for (unsigned int side = 0; side < 2 * dim; ++side)
        sides += box_side_names()[side] + ": 0; ";
      return Settings{{"Domain/Cells", cells[dim]},
                      {"Domain/Nodes", "cell centers"},
                      {"Peridynamics/Kernel", kernel},
                      {"Peridynamics/Kernel exponent", std::to_string(n)},
                      {"Peridynamics/Boundary treatment", "fictitious mirror"},
                      {"Boundary conditions/Dirichlet", sides}};
    };
    for (const char *kernel : {"constant", "conical", "gaussian"})
      for (unsigned int n = 0; n < 3; ++n)
        {
          const std::string what = std::string(kernel) + std::to_string(n);
          check(Problem<1>(settings(1, kernel, n)), what + " 1D");
          check(Problem<2>(settings(2, kernel, n)), what + " 2D");
          check(Problem<3>(settings(3, kernel, n)), what + " 3D");
        }
  }


  TEST(Steppers, chebyshev_with_constant_loads)
  {
    // Against RK4 with tiny steps: source, flux, convection, Dirichlet value and a crack.
    const Problem<2> problem({{"Domain/Cells", "10, 10"},
                              {"Cracks/Segments", "0.23,0.51 ; 0.77,0.53"},
                              {"Material/Density", "1 + x"},
                              {"Initial and source/Source", "3 + y"},
                              {"Boundary conditions/Dirichlet", "left: 2 + y"},
                              {"Boundary conditions/Flux", "top: 1 + x"},
                              {"Boundary conditions/Convection", "right: 3, 5"}});
    EXPECT_EQ(choose_stepper(problem.op()), "chebyshev");
    Vector u = problem.vector(), v = problem.vector();
    problem.op().distribute(u, 0.);
    problem.op().distribute(v, 0.);
    const double dt = 0.1 / problem.op().spectrum().sharp;
    make_stepper("chebyshev", problem.op(), options_with(-1., 1e-12))->advance(u, 0., 0.05);
    make_stepper("rk4", problem.op(), options_with(dt))->advance(v, 0., 0.05);
    EXPECT_LT(largest_difference(u, v), 1e-6 * u.linfty_norm());
  }


  TEST(Steppers, stability_bounds)
  {
    const Problem<2> problem(
      {{"Domain/Cells", "12, 12"}, {"Boundary conditions/Dirichlet", "left: 0 ; right: 0"}});
    const Spectrum spectrum = problem.op().spectrum();
    for (const std::string name : {"euler", "rk4"})
      {
        const double bound = stable_step(name, spectrum.sharp);
        SceneTests::expect_error(
          [&] { make_stepper(name, problem.op(), options_with(1.001 * bound)); },
          {"'Time step'", name, "Lanczos", "Gershgorin", "auto"});
        auto   stepper = make_stepper(name, problem.op(), options_with(0.999 * bound));
        Vector u       = problem.values(
          [&](const auto &p) { return std::sin(12.9898 * p[0] * 1e3 + 78.233 * p[1] * 1e3); });
        problem.op().distribute(u, 0.);
        const double start = u.linfty_norm();
        stepper->advance(u, 0., 2000. * 0.999 * bound);
        EXPECT_EQ(stepper->cost().steps, 2000u);
        EXPECT_LT(u.linfty_norm(), start) << name;
      }
    EXPECT_EQ(stable_step("rkc2", 1.), std::numeric_limits<double>::infinity());
  }
} // namespace PeriDeal
