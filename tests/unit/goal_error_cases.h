// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/analysis/goal_error.h>
#include <perideal/analysis/point_evaluator.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include "distorted_mesh.h"
#include "operator_test_tools.h"

namespace PeriDeal
{
  /** Steady problems with known solutions, whose errors are estimated. */
  namespace GoalCases
  {
    using dealii::Point;
    using OperatorTests::distorted_mesh;
    using OperatorTests::operator+;
    using OperatorTests::Settings;
    namespace numbers = dealii::numbers;

    template <int dim>
    using Function = std::function<double(const Point<dim> &)>;


    /** A steady problem with a known solution, and what is asked of it. */
    template <int dim>
    struct Case
    {
      std::string            name;
      Settings               settings;
      Function<dim>          exact;
      std::vector<Goal<dim>> goals;
      std::vector<double>    values; // of the goals
    };


    /** The true error and what three estimates say of it. */
    struct Row
    {
      double error = 0., weighted = 0., corrected = 0., quadratic = 0.;
    };


    /** Of finite elements. */
    template <int dim>
    double value_at(const dealii::DoFHandler<dim> &dofs,
                    const Cracks<dim>             &cracks,
                    const Point<dim>              &p,
                    const Vector                  &u)
    {
      const std::vector<double> point(p.begin_raw(), p.end_raw());
      return PointEvaluator<dim>(dofs, nullptr, cracks, {point}, "point").evaluate(u)[0];
    }


    /** PERIDEAL_TABLES in the environment: print what is compared, and more of it. */
    inline bool with_tables()
    {
      return std::getenv("PERIDEAL_TABLES") != nullptr;
    }


    /** A row of a table in Markdown. */
    inline void print_row(const std::string &name, const Row &row)
    {
      if (with_tables() && OperatorTests::this_process() == 0)
        std::printf("| %s | %.3e | %.3e | %.3f | %.3f | %.3f |\n",
                    name.c_str(),
                    row.error,
                    row.weighted,
                    row.weighted / row.error,
                    row.corrected / row.error,
                    row.quadratic / row.error);
    }


    inline Settings cells(const unsigned int n, const int dim = 2)
    {
      std::string text = std::to_string(n);
      for (int d = 1; d < dim; ++d)
        text += ", " + std::to_string(n);
      return {{"Domain/Cells", text}};
    }


    inline std::string everywhere(const std::string &formula, const int dim = 2)
    {
      std::string text;
      for (int side = 0; side < 2 * dim; ++side)
        text += (side > 0 ? "; " : "") + box_side_names()[side] + ": " + formula;
      return text;
    }


    /** u = sin(pi x) sin(pi y), 0 on all sides. */
    inline Case<2> smooth()
    {
      return {"smooth",
              {{"Time/Steady", "true"},
               {"Initial and source/Source", "2*Pi^2*sin(Pi*x)*sin(Pi*y)"},
               {"Boundary conditions/Dirichlet", everywhere("0")}},
              [](const Point<2> &p) {
                return std::sin(numbers::PI * p[0]) * std::sin(numbers::PI * p[1]);
              },
              {Goal<2>::value_at({0.5, 0.25}),
               Goal<2>::value_at({0.3, 0.42}),
               Goal<2>::flow_through("left")},
              {std::sin(0.25 * numbers::PI),
               std::sin(0.3 * numbers::PI) * std::sin(0.42 * numbers::PI),
               -2.}};
    }


    /** The same on quadrilaterals whose vertices are moved by up to a fifth of their size. */
    inline Case<2> distorted(const unsigned int n)
    {
      Case<2> test  = smooth();
      test.name     = "distorted";
      test.settings = test.settings + Settings{{"Domain/Shape", "mesh file"},
                                               {"Domain/Mesh file", distorted_mesh<2>(n, 0.2)},
                                               {"Boundary conditions/Dirichlet", "0: 0"}};
      test.goals    = {Goal<2>::value_at({0.3, 0.42})};
      test.values   = {std::sin(0.3 * numbers::PI) * std::sin(0.42 * numbers::PI)};
      return test;
    }


    /** u = sin(pi x) sin(pi y) sin(pi z). */
    inline Case<3> cube()
    {
      const auto u = [](const Point<3> &p) {
        return std::sin(numbers::PI * p[0]) * std::sin(numbers::PI * p[1]) *
               std::sin(numbers::PI * p[2]);
      };
      return {"cube",
              {{"Time/Steady", "true"},
               {"Initial and source/Source", "3*Pi^2*sin(Pi*x)*sin(Pi*y)*sin(Pi*z)"},
               {"Boundary conditions/Dirichlet", everywhere("0", 3)}},
              u,
              {Goal<3>::value_at({0.5, 0.25, 0.5}), Goal<3>::value_at({0.3, 0.42, 0.6})},
              {u({0.5, 0.25, 0.5}), u({0.3, 0.42, 0.6})}};
    }


    /** u = exp(x) sin(y), with a value, a flux and convection. */
    inline Case<2> mixed()
    {
      return {"mixed",
              {{"Time/Steady", "true"},
               {"Boundary conditions/Dirichlet", "left: sin(y)"},
               {"Boundary conditions/Flux", "bottom: -exp(x) ; top: exp(x)*cos(1)"},
               {"Boundary conditions/Convection", "right: 2, 1.5*exp(1)*sin(y)"}},
              [](const Point<2> &p) { return std::exp(p[0]) * std::sin(p[1]); },
              {Goal<2>::value_at({0.5, 0.5}),
               Goal<2>::value_at({0.3, 0.42}),
               Goal<2>::flow_through("left"),
               Goal<2>::flow_through("right")},
              {std::exp(0.5) * std::sin(0.5),
               std::exp(0.3) * std::sin(0.42),
               -(1. - std::cos(1.)),
               std::exp(1.) * (1. - std::cos(1.))}};
    }


    /** u = tanh(10 (x + y - 1)): a layer across the diagonal. */
    inline Case<2> layer()
    {
      const auto u = [](const Point<2> &p) { return std::tanh(10. * (p[0] + p[1] - 1.)); };
      // What enters on the left is the integral of -du/dx.
      const double flow = -std::tanh(10.);
      return {"layer",
              {{"Time/Steady", "true"},
               {"Initial and source/Source", "400*tanh(10*(x+y-1))*(1-tanh(10*(x+y-1))^2)"},
               {"Boundary conditions/Dirichlet", everywhere("tanh(10*(x+y-1))")}},
              u,
              {Goal<2>::value_at({0.5, 0.5625}),
               Goal<2>::value_at({0.3, 0.62}),
               Goal<2>::flow_through("left")},
              {u({0.5, 0.5625}), u({0.3, 0.62}), flow}};
    }


    /** kappa = 1 + x y, u = sin(x + 2 y). */
    inline Case<2> graded()
    {
      const auto u = [](const Point<2> &p) { return std::sin(p[0] + 2. * p[1]); };
      return {"graded",
              {{"Time/Steady", "true"},
               {"Material/Conductivity", "1 + x*y"},
               {"Initial and source/Source", "5*(1+x*y)*sin(x+2*y) - (y+2*x)*cos(x+2*y)"},
               {"Boundary conditions/Dirichlet", "left: sin(2*y) ; right: sin(1+2*y)"},
               {"Boundary conditions/Flux", "bottom: -2*cos(x) ; top: 2*(1+x)*cos(x+2)"}},
              u,
              {Goal<2>::value_at({0.5, 0.25}),
               Goal<2>::value_at({0.3, 0.42}),
               Goal<2>::flow_through("left")},
              {u({0.5, 0.25}), u({0.3, 0.42}), -0.5 * std::sin(2.)}};
    }


    /** u = Im sqrt(z), insulated on the crack from the left side to the middle. */
    inline Case<2> crack(const std::string &mesh)
    {
      const auto u = [](const Point<2> &p) {
        return std::sqrt(p.norm()) * std::sin(0.5 * std::atan2(p[1], p[0]));
      };
      const std::string value = "(x^2+y^2)^0.25*sin(atan2(y,x)/2)";
      // du/dy = d Re sqrt(z)/dx: what enters at the top is the difference at its ends.
      const auto re = [](const Point<2> &p) {
        return std::sqrt(p.norm()) * std::cos(0.5 * std::atan2(p[1], p[0]));
      };
      return {"crack, " + mesh,
              {{"Time/Steady", "true"},
               {"Domain/Lower corner", "-1, -1"},
               {"Domain/Upper corner", "1, 1"},
               {"Cracks/Segments", "-1.5,0 ; 0,0"},
               {"Cracks/Mesh", mesh},
               {"Boundary conditions/Dirichlet",
                "top: " + value + " ; bottom: " + value + " ; right: " + value},
               {"Boundary conditions/Flux", "left: sin(atan2(y,x)/2)/(2*(x^2+y^2)^0.25)"}},
              u,
              {Goal<2>::value_at({0.5, 0.5}),
               Goal<2>::value_at({-0.3, 0.42}),
               Goal<2>::flow_through("top")},
              {u({0.5, 0.5}), u({-0.3, 0.42}), re({1., 1.}) - re({-1., 1.})}};
    }
  } // namespace GoalCases
} // namespace PeriDeal
