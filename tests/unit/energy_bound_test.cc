// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>

#include <perideal/analysis/energy_bound.h>
#include <perideal/solvers/linear_solver.h>

#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <memory>

#include "angle_mesh.h"
#include "goal_error_cases.h"

namespace PeriDeal
{
  using namespace dealii;
  using namespace OperatorTests;
  using namespace GoalCases;

  namespace
  {
    Settings degree(const unsigned int p)
    {
      return {{"Finite elements/Degree", std::to_string(p)}};
    }


    /** Finite elements of any degree, their solution, and what bounds its error. */
    template <int dim>
    struct Bounded
    {
      explicit Bounded(const Settings &settings, const MPI_Comm communicator = MPI_COMM_WORLD)
        : problem(settings, ModelKind::finite_elements, communicator)
        , u(problem.vector())
        , solver(problem.op(), 1e-12, 4000)
        , bounds(problem.op(), problem.scene, [this](Vector &x, const Vector &b) {
          solver.solve(0., 1., x, b);
        })
      {
        EXPECT_EQ(EnergyBounds<dim>::why_not(problem.scene), "");
        solve_steady(problem.op(), u, 0., 1e-12, 4000);
      }

      Problem<dim>      problem;
      Vector            u;
      LinearSolver      solver;
      EnergyBounds<dim> bounds;
    };


    /** Of a function, by differences. */
    template <int dim>
    Tensor<1, dim> gradient_of(const Function<dim> &f, const Point<dim> &p)
    {
      constexpr double step = 1e-5;
      Tensor<1, dim>   gradient;
      for (unsigned int d = 0; d < dim; ++d)
        {
          Point<dim> ahead = p, behind = p;
          ahead[d] += step;
          behind[d] -= step;
          gradient[d] = (f(ahead) - f(behind)) / (2. * step);
        }
      return gradient;
    }


    /** The energy norm of exact - u, with that of sides with convection. */
    template <int dim>
    double energy_error(const Bounded<dim> &solved, const Function<dim> &exact)
    {
      const auto &dofs  = solved.problem.handler;
      const auto &scene = solved.problem.scene;
      IndexSet    relevant;
      DoFTools::extract_locally_relevant_dofs(dofs, relevant);
      Vector u(dofs.locally_owned_dofs(), relevant, dofs.get_communicator());
      u.copy_locally_owned_data_from(solved.u);
      u.update_ghost_values();
      const unsigned int          n = dofs.get_fe().degree + 2;
      FEValues<dim>               values(dofs.get_fe(),
                           QIterated<dim>(QGauss<1>(n), dim == 3 ? 1 : 4),
                           update_gradients | update_quadrature_points | update_JxW_values);
      FEFaceValues<dim>           on_face(dofs.get_fe(),
                                QGauss<dim - 1>(n + 2),
                                update_values | update_quadrature_points | update_JxW_values);
      std::vector<Tensor<1, dim>> gradients(values.n_quadrature_points);
      std::vector<double>         at_face(on_face.n_quadrature_points);
      double                      square = 0.;
      for (const auto &cell : dofs.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            values.reinit(cell);
            values.get_function_gradients(u, gradients);
            for (const unsigned int q : values.quadrature_point_indices())
              square +=
                values.JxW(q) * scene.material.conductivity.value(values.quadrature_point(q)) *
                (gradient_of<dim>(exact, values.quadrature_point(q)) - gradients[q]).norm_square();
            for (const unsigned int f : cell->face_indices())
              for (const SurfaceTransfer &transfer : scene.boundary_conditions.transfers)
                if (cell->at_boundary(f) && cell->face(f)->boundary_id() == transfer.id &&
                    transfer.fixes_level())
                  {
                    on_face.reinit(cell, f);
                    on_face.get_function_values(u, at_face);
                    for (const unsigned int q : on_face.quadrature_point_indices())
                      square += on_face.JxW(q) *
                                transfer.coefficient.value(on_face.quadrature_point(q)) *
                                std::pow(exact(on_face.quadrature_point(q)) - at_face[q], 2);
                  }
          }
      return std::sqrt(sum_of_all(square));
    }


    /** kappa is 1 at x < 1/2 and 100 beyond; u = X(x) cos(pi y), insulated below and above. */
    Case<2> jump()
    {
      constexpr double pi = numbers::PI;
      const auto       u  = [](const Point<2> &p) {
        const double x = p[0] - 0.5;
        return (x < 0. ? std::sinh(pi * p[0]) :
                                std::sinh(0.5 * pi) * std::cosh(pi * x) +
                           0.01 * std::cosh(0.5 * pi) * std::sinh(pi * x)) *
               std::cos(pi * p[1]);
      };
      return {"jump",
              {{"Time/Steady", "true"},
               {"Material/Conductivity", "1"},
               {"Material/Phases/Regions", "dense: x > 0.5"},
               {"Material/Phases/Conductivity", "dense: 100"},
               {"Boundary conditions/Dirichlet",
                "left: 0 ; right: (sinh(pi/2)*cosh(pi/2) + 0.01*cosh(pi/2)*sinh(pi/2))*cos(pi*y)"}},
              u,
              {},
              {}};
    }


    /** kappa = 1 + x y, u = exp(x) sin(y), with convection on the right. */
    Case<2> graded_convection()
    {
      constexpr double one = 1.;
      return {"graded, convection",
              {{"Time/Steady", "true"},
               {"Material/Conductivity", "1 + x*y"},
               {"Initial and source/Source", "-exp(x)*(y*sin(y) + x*cos(y))"},
               {"Boundary conditions/Dirichlet", "left: sin(y)"},
               {"Boundary conditions/Flux", "bottom: -exp(x) ; top: (1+x)*exp(x)*cos(1)"},
               {"Boundary conditions/Convection", "right: 2, exp(1)*sin(y)*(1.5 + 0.5*y)"}},
              [](const Point<2> &p) { return std::exp(p[0]) * std::sin(p[1]); },
              {Goal<2>::flow_through("left"), Goal<2>::flow_through("right")},
              {std::cos(one) - 1., std::exp(one) * (1. + std::sin(one) - 2. * std::cos(one))}};
    }


    /** u = r^(2/3) sin(2 phi/3) around the corner of an angle. */
    Case<2> corner(const unsigned int n)
    {
      const auto u = [](const Point<2> &p) {
        double phi = std::atan2(p[1], p[0]);
        if (phi < -1e-12)
          phi += 2. * numbers::PI;
        return std::pow(p.norm(), 2. / 3.) * std::sin(2. * phi / 3.);
      };
      return {"corner",
              {{"Time/Steady", "true"},
               {"Domain/Shape", "mesh file"},
               {"Domain/Mesh file", angle_mesh(n)},
               {"Boundary conditions/Dirichlet",
                "0: (x^2+y^2)^(1/3)*sin(2/3*(atan2(y,x) + (atan2(y,x) < -1e-12 ? 2*pi : 0)))"}},
              u,
              {},
              {}};
    }


    /** Error, bound, effectivity; returns the latter. */
    template <int dim>
    double effectivity(const Case<dim> &test, const Settings &more, const std::string &words)
    {
      const Bounded<dim> solved(test.settings + more);
      const EnergyBound  bound = solved.bounds.of(solved.u);
      const double       error = energy_error<dim>(solved, test.exact);
      EXPECT_EQ(bound.reservation, "") << test.name;
      if (with_tables() && this_process() == 0)
        std::printf("| %s | %s | %.3e | %.3e | %.3f | %.1e | %.1e | %.1e |\n",
                    test.name.c_str(),
                    words.c_str(),
                    error,
                    bound.bound,
                    bound.bound / error,
                    bound.oscillation / bound.bound,
                    bound.values / bound.bound,
                    bound.remainder / bound.bound);
      return bound.bound / error;
    }
  } // namespace


  namespace
  {
    /** Processor time since a start, in seconds. */
    double processor_seconds(const std::clock_t start)
    {
      return double(std::clock() - start) / CLOCKS_PER_SEC;
    }


    /** How long the bound of a larger problem takes, and operator and solution. */
    template <int dim>
    void print_seconds(const Case<dim> &test, const Settings &more, const std::string &words)
    {
      const Bounded<dim> solved(test.settings + more);
      const std::clock_t start = std::clock();
      const auto field       = field_of_elements<dim>(solved.problem.handler, solved.problem.scene);
      FieldOperator<dim> &op = *field;
      Vector              u  = solved.problem.vector();
      solve_steady(op, u, 0., 1e-10, 4000);
      const double       of_solution = processor_seconds(start);
      const std::clock_t again       = std::clock();
      const EnergyBound  bound       = solved.bounds.of(u);
      const double       of_bound    = processor_seconds(again);
      EXPECT_GT(bound.bound, 0.);
      if (this_process() == 0)
        std::printf("| %s | %s | %u | %.2f | %.2f | %.2f |\n",
                    test.name.c_str(),
                    words.c_str(),
                    static_cast<unsigned int>(u.size()),
                    of_solution,
                    of_bound,
                    of_bound / of_solution);
    }


    void print_all_seconds()
    {
      print_seconds<2>(smooth(), cells(256), "Q1");
      print_seconds<2>(smooth(), cells(128) + degree(2), "Q2");
      print_seconds<2>(smooth(), cells(96) + degree(3), "Q3");
      print_seconds<2>(graded(), cells(256), "Q1");
      print_seconds<2>(distorted(192), {}, "Q1");
      print_seconds<3>(cube(), cells(32, 3), "Q1");
      print_seconds<3>(cube(), cells(16, 3) + degree(2), "Q2");
    }
  } // namespace


  TEST(EnergyBounds, never_below_the_error)
  {
    using Counts      = std::vector<unsigned int>;
    const Counts flat = with_tables() ? Counts{8, 16, 32, 64} : Counts{8, 16};
    for (const unsigned int p : {1, 2, 3})
      for (const unsigned int n : flat)
        {
          const std::string    words = "Q" + std::to_string(p) + " | " + std::to_string(n);
          std::vector<Case<2>> tests{smooth(),
                                     mixed(),
                                     layer(),
                                     graded(),
                                     graded_convection(),
                                     jump(),
                                     crack("faces")};
          for (const Case<2> &test : tests)
            {
              const double ratio = effectivity<2>(test, cells(n) + degree(p), words);
              EXPECT_GT(ratio, 1. - 1e-6) << test.name << ' ' << words;
              EXPECT_LT(ratio, 2.) << test.name << ' ' << words;
            }
          for (const Case<2> &test : {distorted(n), corner(n / 2)})
            {
              const double ratio = effectivity<2>(test, degree(p), words);
              EXPECT_GT(ratio, 1. - 1e-6) << test.name << ' ' << words;
              EXPECT_LT(ratio, 2.) << test.name << ' ' << words;
            }
          Case<2> hanging = smooth();
          hanging.name    = "hanging nodes";
          if (n >= 16)
            {
              const double ratio = effectivity<2>(
                hanging,
                cells(n) + degree(p) +
                  Settings{{"Domain/Coarsening", "1"}, {"Domain/Fine where", "0.3 - x"}},
                words);
              EXPECT_GT(ratio, 1. - 1e-6) << words;
              EXPECT_LT(ratio, 2.) << words;
            }
        }
  }


  TEST(EnergyBounds, in_one_and_three_dimensions)
  {
    if (with_tables())
      print_all_seconds();
    const auto    wave = [](const Point<1> &p) { return std::sin(numbers::PI * p[0]); };
    const Case<1> line{"line",
                       {{"Time/Steady", "true"},
                        {"Initial and source/Source", "pi^2*sin(pi*x)"},
                        {"Boundary conditions/Dirichlet", "left: 0"},
                        {"Boundary conditions/Flux", "right: -pi"}},
                       wave,
                       {},
                       {}};
    const auto    u = [](const Point<3> &p) { return std::exp(p[0]) * std::sin(p[1] + p[2]); };
    const Case<3> block{"block",
                        {{"Time/Steady", "true"},
                         {"Initial and source/Source", "exp(x)*sin(y+z)"},
                         {"Boundary conditions/Dirichlet", "left: sin(y+z) ; top: exp(x)*sin(1+z)"},
                         {"Boundary conditions/Flux",
                          "bottom: -exp(x)*cos(z) ; back: -exp(x)*cos(y) ; front: exp(x)*cos(y+1)"},
                         {"Boundary conditions/Convection", "right: 2, 1.5*exp(1)*sin(y+z)"}},
                        u,
                        {},
                        {}};
    const auto    check = [](const double ratio, const std::string &words) {
      EXPECT_GT(ratio, 1. - 1e-6) << words;
      EXPECT_LT(ratio, 2.) << words;
    };
    for (const unsigned int p : {1, 2, 3})
      check(effectivity<1>(line, cells(8, 1) + degree(p), "Q" + std::to_string(p) + " | 8"),
            "line");
    for (const unsigned int p : {1, 2})
      for (const unsigned int n : {4, 8})
        {
          const std::string words = "Q" + std::to_string(p) + " | " + std::to_string(n);
          if (p == 2 && n == 8 && !with_tables())
            continue;
          check(effectivity<3>(cube(), cells(n, 3) + degree(p), words), "cube " + words);
          check(effectivity<3>(block, cells(n, 3) + degree(p), words), "block " + words);
          Case<3> other = cube();
          other.name    = "distorted cube";
          other.settings =
            other.settings + Settings{{"Domain/Shape", "mesh file"},
                                      {"Domain/Mesh file", distorted_mesh<3>(n, 0.2)},
                                      {"Boundary conditions/Dirichlet", "0: 0"}};
          check(effectivity<3>(other, degree(p), words), "distorted cube " + words);
          other      = cube();
          other.name = "cube, hanging nodes";
          check(
            effectivity<3>(other,
                           cells(2 * n, 3) + degree(p) +
                             Settings{{"Domain/Coarsening", "1"}, {"Domain/Fine where", "0.2 - x"}},
                           words),
            other.name + ' ' + words);
        }
  }


  TEST(EnergyBounds, fields_that_elements_have)
  {
    const Settings   linear{{"Time/Steady", "true"},
                          {"Material/Phases/Regions", "dense: x > 0.5"},
                          {"Material/Phases/Conductivity", "dense: 4"},
                          {"Boundary conditions/Dirichlet", "left: 0"},
                          {"Boundary conditions/Convection", "right: 2, 3"}};
    const Bounded<2> plane(linear + cells(6));
    EXPECT_LT(plane.bounds.of(plane.u).bound, 1e-8);
    const Bounded<3> space(linear + cells(4, 3));
    EXPECT_LT(space.bounds.of(space.u).bound, 1e-8);
    EXPECT_GT(space.bounds.of(space.u).norm, 0.1);
  }


  namespace
  {
    /** What enters through the left of a problem, weighted as the elements do: 1 there. */
    double weighted_flow(const Case<2> &test, const unsigned int n)
    {
      const QGauss<1> line(12);
      double          flow = 0.;
      for (unsigned int q = 0; q < line.size(); ++q)
        {
          const double s = line.point(q)[0], w = line.weight(q);
          flow -= w * gradient_of<2>(test.exact, Point<2>(0., s))[0];
          // 1 at the left end of the first faces of the sides below and above.
          flow -= w / n * (1. - s) * gradient_of<2>(test.exact, Point<2>(s / n, 0.))[1];
          flow += w / n * (1. - s) * gradient_of<2>(test.exact, Point<2>(s / n, 1.))[1];
        }
      return flow;
    }


    /** The true flow is where it has to be; returns the width over it. */
    double check_flow(const Case<2>     &test,
                      const Settings    &more,
                      const std::string &side,
                      const double       exact,
                      const std::string &words)
    {
      const Bounded<2> solved(test.settings + more);
      const FlowBound  flow   = solved.bounds.of_flow_through(side, solved.u);
      const double     width  = 0.5 * (flow.upper - flow.lower);
      const double     middle = 0.5 * (flow.upper + flow.lower);
      EXPECT_LE(flow.lower, exact + 1e-9) << test.name << ' ' << side << ' ' << words;
      EXPECT_GE(flow.upper, exact - 1e-9) << test.name << ' ' << side << ' ' << words;
      if (with_tables() && this_process() == 0)
        std::printf("| %s, %s | %s | %.6f | %.2e | %.2e | %.2e |\n",
                    test.name.c_str(),
                    side.c_str(),
                    words.c_str(),
                    exact,
                    flow.value - exact,
                    middle - exact,
                    width);
      return width / std::abs(exact);
    }
  } // namespace


  TEST(EnergyBounds, flows_are_between_their_bounds)
  {
    for (const unsigned int p : {1, 2})
      for (const unsigned int n : {8, 16, 32})
        {
          if (n > 16 && !with_tables())
            continue;
          const std::string words = "Q" + std::to_string(p) + " | " + std::to_string(n);
          const Settings    more  = cells(n) + degree(p);
          const double      most  = p == 1 ? 2. / n : 4. / n / n / n;
          for (const Case<2> &test : {mixed(), graded(), graded_convection()})
            for (std::size_t k = 0; k < test.goals.size(); ++k)
              if (const std::string side = test.goals[k].side; !side.empty())
                {
                  EXPECT_LT(check_flow(test, more, side, test.values[k], words), most)
                    << test.name << words;
                }
          if (p == 1)
            {
              // Values all around: the trace of the dual solution depends on the mesh.
              const double s = weighted_flow(smooth(), n);
              check_flow(smooth(), more, "left", s, words);
              check_flow(layer(), more, "left", weighted_flow(layer(), n), words);
            }
        }
  }


  TEST(EnergyBounds, what_they_cannot_be_had_for)
  {
    const auto words = [](const Settings &settings) {
      Scene<2> scene;
      set(scene, settings);
      return EnergyBounds<2>::why_not(scene);
    };
    const Settings plain = smooth().settings + cells(8);
    EXPECT_EQ(words(plain), "");
    EXPECT_NE(words(crack("pairs").settings + cells(9)), "");
    EXPECT_EQ(words(crack("faces").settings + cells(8)), "");
    EXPECT_NE(words(plain + Settings{{"Material/Conductivity", "1 + T^2"}}), "");
  }


  TEST(EnergyBounds, same_on_every_number_of_processes)
  {
    const auto compare = [](const auto &of_dim, const Settings &settings, const std::string &name) {
      constexpr int      dim = std::decay_t<decltype(of_dim)>::dimension;
      const Bounded<dim> one(settings, MPI_COMM_SELF), all(settings);
      const EnergyBound  a = one.bounds.of(one.u), b = all.bounds.of(all.u);
      EXPECT_GT(a.bound, 0.) << name;
      EXPECT_NEAR(a.bound, b.bound, 1e-7 * a.bound) << name;
      EXPECT_NEAR(a.flux, b.flux, 1e-7 * a.bound) << name;
      EXPECT_NEAR(a.values, b.values, 1e-7 * a.bound) << name;
      EXPECT_NEAR(a.oscillation, b.oscillation, 1e-7 * a.bound) << name;
      EXPECT_NEAR(a.norm, b.norm, 1e-7 * a.norm) << name;
      double sum = 0.;
      for (const double square : b.cells)
        sum += square;
      EXPECT_NEAR(std::sqrt(sum_of_all(sum)), a.flux, 1e-7 * a.bound) << name;
    };
    const Settings half_fine{{"Domain/Coarsening", "1"}, {"Domain/Fine where", "0.3 - x"}};
    for (const unsigned int p : {1, 2})
      {
        compare(Point<2>(), mixed().settings + cells(16) + degree(p), "mixed");
        compare(Point<2>(), layer().settings + cells(16) + half_fine + degree(p), "layer");
        compare(Point<2>(), crack("faces").settings + cells(16) + degree(p), "crack");
      }
    compare(Point<2>(), distorted(12).settings, "distorted");
    compare(Point<3>(), cube().settings + cells(8, 3) + half_fine, "cube");
    const Settings   flows = mixed().settings + cells(12);
    const Bounded<2> one(flows, MPI_COMM_SELF), all(flows);
    for (const std::string side : {"left", "right"})
      {
        const FlowBound a = one.bounds.of_flow_through(side, one.u);
        const FlowBound b = all.bounds.of_flow_through(side, all.u);
        EXPECT_NEAR(a.lower, b.lower, 1e-9) << side;
        EXPECT_NEAR(a.upper, b.upper, 1e-9) << side;
      }
  }
} // namespace PeriDeal
