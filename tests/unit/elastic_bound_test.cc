// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>

#include <perideal/analysis/elastic_bound.h>
#include <perideal/laws/elasticity.h>
#include <perideal/solvers/linear_solver.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <memory>

#include "angle_mesh.h"
#include "distorted_mesh.h"
#include "elastic_test_tools.h"

namespace PeriDeal
{
  using namespace dealii;
  using namespace OperatorTests;

  namespace
  {
    /** A body at rest whose displacement is known. */
    struct SolidCase
    {
      std::string              name;
      Settings                 settings;
      std::vector<std::string> exact; // of each component, of x and y
    };


    bool prints_tables()
    {
      return std::getenv("PERIDEAL_TABLES") != nullptr;
    }


    Settings of_degree(const unsigned int p)
    {
      return {{"Finite elements/Degree", std::to_string(p)}};
    }


    Settings square(const unsigned int n)
    {
      return {{"Domain/Cells", std::to_string(n) + ", " + std::to_string(n)}};
    }


    /** Finite elements, their solution, and what bounds its error. */
    struct BoundedSolid
    {
      explicit BoundedSolid(const Settings &settings, const MPI_Comm communicator = MPI_COMM_WORLD)
        : body(settings, ModelKind::finite_elements, communicator)
        , solver(body.op(), 1e-12, 8000)
        , bounds(*body.elements, body.handler, body.scene, [this](Vector &x, const Vector &b) {
          solver.solve(0., 1., x, b);
        })
      {
        EXPECT_EQ(ElasticBounds<2>::why_not(body.scene), "");
        u = body.vector();
        body.op().distribute(u, 0.);
        Vector change = body.vector();
        solver.solve(0., 1., change, body.residual(u));
        u += change;
        body.op().distribute(u, 0.);
      }

      Body<2>          body;
      LinearSolver     solver;
      ElasticBounds<2> bounds;
      Vector           u;
    };


    /** The energy norm of exact - u, by differences of the exact one. */
    double energy_error(const BoundedSolid &solved, const SolidCase &test)
    {
      constexpr double        step = 1e-5;
      std::vector<Expression> exact;
      for (const std::string &text : test.exact)
        exact.emplace_back(text, "the test");
      const auto &dofs  = solved.body.handler;
      const auto &scene = solved.body.scene;
      Vector      u     = solved.body.vector();
      u.copy_locally_owned_data_from(solved.u);
      u.update_ghost_values();
      FEValues<2>                          values(dofs.get_fe(),
                         QIterated<2>(QGauss<1>(dofs.get_fe().degree + 2), 4),
                         update_gradients | update_quadrature_points | update_JxW_values);
      std::vector<types::global_dof_index> indices(dofs.get_fe().n_dofs_per_cell());
      double                               square = 0.;
      for (const auto &cell : dofs.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            values.reinit(cell);
            cell->get_dof_indices(indices);
            for (const unsigned int q : values.quadrature_point_indices())
              {
                const Point<2> &p = values.quadrature_point(q);
                Tensor<2, 2>    gradient;
                for (unsigned int c = 0; c < 2; ++c)
                  for (unsigned int d = 0; d < 2; ++d)
                    {
                      Point<2> ahead = p, behind = p;
                      ahead[d] += step;
                      behind[d] -= step;
                      gradient[c][d] =
                        (exact[c].value(ahead) - exact[c].value(behind)) / (2. * step);
                      for (unsigned int i = 0; i < indices.size(); ++i)
                        gradient[c][d] -= u(2 * indices[i] + c) * values.shape_grad(i, q)[d];
                    }
                const SymmetricTensor<2, 2> strain = symmetrize(gradient);
                square +=
                  values.JxW(q) *
                  (stress(scene.material.moduli(p), scene.elasticity.plane, strain) * strain);
              }
          }
      return std::sqrt(Utilities::MPI::sum(square, dofs.get_communicator()));
    }


    std::string on_all_sides(const std::string &what)
    {
      return "left: " + what + " ; right: " + what + " ; bottom: " + what + " ; top: " + what;
    }


    Settings material(const std::string &young,
                      const std::string &poisson,
                      const std::string &plane)
    {
      return {{"Material/Young modulus", young},
              {"Material/Poisson ratio", poisson},
              {"Elasticity/Plane", plane}};
    }


    SolidCase plane_stress()
    {
      return {"plane stress",
              material("1", "0.3", "stress") +
                Settings{{"Initial and source/Body force",
                          "5*pi^2*(27*sin(pi*x)*sin(pi*y) - 13*cos(2*pi*x)*cos(pi*y))/91, "
                          "5*pi^2*(48*sin(pi*x)*sin(pi*y) - 13*cos(pi*y))*cos(pi*x)/91"},
                         {"Boundary conditions/Displacement", on_all_sides("0, 0")}},
              {"sin(pi*x)*sin(pi*y)", "sin(2*pi*x)*sin(pi*y)/2"}};
    }


    /** Of a field without divergence. */
    SolidCase plane_strain(const std::string &poisson)
    {
      const std::string g = "2*pi^2/(2*(1+" + poisson + "))";
      return {
        "plane strain, " + poisson,
        material("1", poisson, "strain") +
          Settings{{"Initial and source/Body force",
                    g + "*2*(sin(2*pi*y) + sin(pi*(2*x - 2*y)) - sin(pi*(2*x + 2*y)))/2*1, " + g +
                      "*2*(-sin(2*pi*x) + sin(pi*(2*x - 2*y)) + sin(pi*(2*x + 2*y)))/2*1"},
                   {"Boundary conditions/Displacement", on_all_sides("0, 0")}},
        {"sin(pi*x)^2*sin(2*pi*y)", "-sin(2*pi*x)*sin(pi*y)^2"}};
    }


    SolidCase tractions()
    {
      return {"tractions",
              material("1", "0.3", "stress") +
                Settings{{"Initial and source/Body force",
                          "5*(4*cos(y) - 1)*exp(x)*sin(y)/7, "
                          "5*(-13*cos(y) + 73*cos(2*y))*exp(x)/91"},
                         {"Boundary conditions/Displacement", "left: sin(y), cos(2*y)"},
                         {"Boundary conditions/Traction",
                          "right: 20*exp(1)*(5 - 6*cos(y))*sin(y)/91, "
                          "5*exp(1)*(cos(y) + cos(2*y))/13 ; "
                          "bottom: -10*exp(x)/13, 0 ; top: 5*(cos(2) + cos(1))*exp(x)/13, "
                          "10*(-20*sin(2) + 3*sin(1))*exp(x)/91"}},
              {"exp(x)*sin(y)", "exp(x)*cos(2*y)"}};
    }


    SolidCase graded()
    {
      return {"graded",
              material("1 + x*y", "0.25", "stress") +
                Settings{{"Initial and source/Body force",
                          "8*x*y*sin(x + 2*y)/3 - 4*x*y*cos(2*x - y)/3 + 4*x*sin(2*x - y)/5 - "
                          "4*x*cos(x + 2*y)/5 - 4*y*sin(2*x - y)/15 - 16*y*cos(x + 2*y)/15 + "
                          "8*sin(x + 2*y)/3 - 4*cos(2*x - y)/3, "
                          "4*x*y*sin(x + 2*y)/3 + 8*x*y*cos(2*x - y)/3 - 16*x*sin(2*x - y)/15 - "
                          "4*x*cos(x + 2*y)/15 + 4*y*sin(2*x - y)/5 - 4*y*cos(x + 2*y)/5 + "
                          "4*sin(x + 2*y)/3 + 8*cos(2*x - y)/3"},
                         {"Boundary conditions/Displacement", "left: sin(2*y), cos(y)"},
                         {"Boundary conditions/Traction",
                          "right: 4*(y + 1)*(-sin(y - 2) + 4*cos(2*y + 1))/15, "
                          "4*(y + 1)*(sin(y - 2) + cos(2*y + 1))/5 ; "
                          "bottom: 4*sin(2*x)/5 - 4*cos(x)/5, -4*(8*sin(x) + 1)*cos(x)/15 ; "
                          "top: -4*(x + 1)*(sin(2*x - 1) - cos(x + 2))/5, "
                          "4*(x + 1)*(4*sin(2*x - 1) + cos(x + 2))/15"}},
              {"sin(x + 2*y)", "cos(2*x - y)"}};
    }


    /** Young's modulus is 1 at x < 1/2 and 100 beyond; u = w/E with w = 0 at x = 1/2. */
    SolidCase layers()
    {
      const std::string w = "sin(2*pi*x)*sin(pi*y)", part = "/if(x > 0.5, 100, 1)";
      return {"layers, 1 to 100",
              material("1", "0.3", "stress") +
                Settings{{"Material/Phases/Regions", "stiff: x > 0.5"},
                         {"Material/Phases/Young modulus", "stiff: 100"},
                         {"Initial and source/Body force",
                          "pi^2*(172*cos(pi*(2*x - y)) - 263*cos(pi*(2*x + y)))/91, "
                          "pi^2*(19*cos(pi*(2*x - y)) - 149*cos(pi*(2*x + y)))/91"},
                         {"Boundary conditions/Displacement", on_all_sides("0, 0")}},
              {w + part, "0.7*" + w + part}};
    }


    /** The same as plane_stress() on quadrilaterals whose vertices are moved. */
    SolidCase distorted(const unsigned int n)
    {
      SolidCase test = plane_stress();
      test.name      = "distorted";
      test.settings  = test.settings + Settings{{"Domain/Shape", "mesh file"},
                                               {"Domain/Mesh file", distorted_mesh<2>(n, 0.2)},
                                               {"Boundary conditions/Displacement", "0: 0, 0"}};
      return test;
    }


    /** Opening of a crack: the first term of Williams' series, E = 1, nu = 0.3, K = 1. */
    SolidCase crack_tip()
    {
      const std::string r = "(x^2+y^2)", half = "(atan2(y,x)/2)";
      const std::string scale = "(1.3*sqrt(sqrt" + r + "/(2*pi)))", kappa = "(2.7/1.3)";
      const std::string u    = scale + "*cos" + half + "*(" + kappa + " - 1 + 2*sin" + half + "^2)",
                        v    = scale + "*sin" + half + "*(" + kappa + " + 1 - 2*cos" + half + "^2)",
                        both = u + ", " + v;
      const std::string three = "(3*atan2(y,x)/2)", k = "/sqrt(2*pi*sqrt" + r + ")";
      return {"crack tip",
              material("1", "0.3", "stress") +
                Settings{{"Domain/Lower corner", "-1, -1"},
                         {"Domain/Upper corner", "1, 1"},
                         {"Cracks/Segments", "-1.5,0 ; 0,0"},
                         {"Cracks/Mesh", "faces"},
                         {"Elasticity/Contact", "false"},
                         {"Boundary conditions/Displacement",
                          "top: " + both + " ; bottom: " + both + " ; right: " + both},
                         {"Boundary conditions/Traction",
                          "left: -cos" + half + "*(1 - sin" + half + "*sin" + three + ")" + k +
                            ", -sin" + half + "*cos" + half + "*cos" + three + k}},
              {u, v}};
    }


    /**
     * An angle without tractions on the sides of its corner, opened: r^0.544 (Ainsworth and Senior
     * 1997), in plane strain with nu = 0.3.
     */
    SolidCase corner(const unsigned int n)
    {
      const std::string r = "(x^2+y^2)", phi = "atan2(-(x+y),y-x)", q = "0.5430755788*1.5444837368";
      const std::string scale = "(1.3*" + r + "^(0.5444837368/2))", kappa = "1.8";
      const std::string l = "0.5444837368";
      // Along the middle of the body and across it.
      const std::string a = scale + "*((" + kappa + " - " + q + ")*cos(" + l + "*" + phi + ") - " +
                            l + "*cos((" + l + "-2)*" + phi + "))",
                        b = scale + "*((" + kappa + " + " + q + ")*sin(" + l + "*" + phi + ") + " +
                            l + "*sin((" + l + "-2)*" + phi + "))";
      const std::string u = "(-(" + a + ") - (" + b + "))/sqrt(2)",
                        v = "((" + a + ") - (" + b + "))/sqrt(2)";
      return {
        "re-entrant corner",
        material("1", "0.3", "strain") +
          Settings{{"Domain/Shape", "mesh file"},
                   {"Domain/Mesh file", angle_mesh(n)},
                   {"Boundary conditions/Parts", "outer: 0 if max(abs(x), abs(y)) > 0.999999"},
                   {"Boundary conditions/Displacement", "outer: " + u + ", " + v}},
        {u, v}};
    }


    /** Error, bound, effectivity; returns the latter. */
    double effectivity(const SolidCase &test, const Settings &more, const std::string &words)
    {
      const BoundedSolid solved(test.settings + more);
      const EnergyBound  bound = solved.bounds.of(solved.u);
      const double       error = energy_error(solved, test);
      EXPECT_EQ(bound.reservation, "") << test.name;
      if (prints_tables() && this_process() == 0)
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


    void check_effectivity(const SolidCase &test, const Settings &more, const std::string &words)
    {
      const double ratio = effectivity(test, more, words);
      EXPECT_GT(ratio, 1. - 1e-6) << test.name << ' ' << words;
      // Nearly incompressible bodies have small constants against large ones.
      EXPECT_LT(ratio, test.name.find("0.49") == std::string::npos ? 2. : 4.)
        << test.name << ' ' << words;
    }
  } // namespace


  TEST(ElasticBounds, never_below_the_error)
  {
    using Counts      = std::vector<unsigned int>;
    const Counts flat = prints_tables() ? Counts{8, 16, 32} : Counts{8};
    for (const unsigned int p : {2, 3})
      for (const unsigned int n : flat)
        {
          const std::string words = "Q" + std::to_string(p) + " | " + std::to_string(n);
          for (const SolidCase &test : {plane_stress(),
                                        plane_strain("0.3"),
                                        plane_strain("0.49"),
                                        tractions(),
                                        graded(),
                                        layers(),
                                        crack_tip()})
            check_effectivity(test, square(n) + of_degree(p), words);
          check_effectivity(distorted(n), of_degree(p), words);
          check_effectivity(corner(n / 2), of_degree(p), words);
          SolidCase hanging = plane_stress();
          hanging.name      = "hanging nodes";
          check_effectivity(
            hanging,
            square(2 * n) + of_degree(p) +
              Settings{{"Domain/Coarsening", "1"}, {"Domain/Fine where", "0.3 - x"}},
            words);
        }
  }


  namespace
  {
    /** How long the bound of a larger problem takes, and operator and solution. */
    void print_seconds(const SolidCase &test, const Settings &more, const std::string &words)
    {
      const auto seconds_since = [](const std::clock_t start) {
        return double(std::clock() - start) / CLOCKS_PER_SEC;
      };
      const std::clock_t start = std::clock();
      const BoundedSolid solved(test.settings + more);
      const double       of_solution = seconds_since(start);
      const std::clock_t again       = std::clock();
      const EnergyBound  bound       = solved.bounds.of(solved.u);
      const double       of_bound    = seconds_since(again);
      EXPECT_GT(bound.bound, 0.);
      if (this_process() == 0)
        std::printf("| %s | %s | %u | %.2f | %.2f | %.2f |\n",
                    test.name.c_str(),
                    words.c_str(),
                    static_cast<unsigned int>(solved.u.size()),
                    of_solution,
                    of_bound,
                    of_bound / of_solution);
    }
  } // namespace


  TEST(ElasticBounds, fields_that_elements_have)
  {
    if (prints_tables())
      {
        print_seconds(plane_stress(), square(64) + of_degree(2), "Q2");
        print_seconds(plane_stress(), square(48) + of_degree(3), "Q3");
        print_seconds(graded(), square(64) + of_degree(2), "Q2");
        print_seconds(distorted(48), of_degree(2), "Q2");
      }
    const Settings bent =
      material("2", "0", "stress") + Settings{{"Material/Phases/Regions", "stiff: x > 0.5"},
                                              {"Material/Phases/Young modulus", "stiff: 8"},
                                              {"Boundary conditions/Symmetry", "bottom"},
                                              {"Boundary conditions/Displacement", "left: 0, free"},
                                              {"Boundary conditions/Traction", "right: 1, 0"}};
    const BoundedSolid pulled(bent + square(6) + of_degree(2));
    const EnergyBound  bound = pulled.bounds.of(pulled.u);
    EXPECT_LT(bound.bound, 1e-8);
    EXPECT_GT(bound.norm, 0.1);
    const BoundedSolid warm(material("2", "0.3", "strain") + square(4) + of_degree(2) +
                            Settings{{"Material/Thermal expansion", "0.1"},
                                     {"Elasticity/Temperature change", "3"},
                                     {"Boundary conditions/Symmetry", "left ; bottom"}});
    EXPECT_LT(warm.bounds.of(warm.u).bound, 1e-8);
    EXPECT_GT(warm.bounds.of(warm.u).norm, 0.1);
  }


  TEST(ElasticBounds, what_they_cannot_be_had_for)
  {
    const auto words = [](const Settings &settings) {
      Scene<2> scene;
      scene.general.set("Models", "finite elements");
      scene.general.set("Physics", "elasticity");
      set(scene, settings);
      return ElasticBounds<2>::why_not(scene);
    };
    const Settings plain = plane_stress().settings + square(8);
    EXPECT_EQ(words(plain + of_degree(2)), "");
    EXPECT_NE(words(plain).find("'Degree' is 1"), std::string::npos);
    EXPECT_EQ(words(crack_tip().settings + square(8) + of_degree(2)), "");
  }


  TEST(ElasticBounds, same_on_every_number_of_processes)
  {
    const auto compare = [](const SolidCase &test, const Settings &more) {
      const BoundedSolid one(test.settings + more, MPI_COMM_SELF), all(test.settings + more);
      const EnergyBound  a = one.bounds.of(one.u), b = all.bounds.of(all.u);
      EXPECT_GT(a.bound, 0.) << test.name;
      EXPECT_NEAR(a.bound, b.bound, 1e-6 * a.bound) << test.name;
      EXPECT_NEAR(a.flux, b.flux, 1e-7 * a.bound) << test.name;
      EXPECT_NEAR(a.values, b.values, 1e-7 * a.bound) << test.name;
      EXPECT_NEAR(a.oscillation, b.oscillation, 1e-7 * a.bound) << test.name;
      EXPECT_NEAR(a.norm, b.norm, 1e-7 * a.norm) << test.name;
      double sum = 0.;
      for (const double square : b.cells)
        sum += square;
      EXPECT_NEAR(std::sqrt(Utilities::MPI::sum(sum, MPI_COMM_WORLD)), a.flux, 1e-7 * a.bound)
        << test.name;
    };
    const Settings half_fine{{"Domain/Coarsening", "1"}, {"Domain/Fine where", "0.3 - x"}};
    compare(tractions(), square(8) + of_degree(2));
    compare(crack_tip(), square(8) + of_degree(2));
    compare(plane_stress(), square(16) + half_fine + of_degree(2));
    compare(distorted(8), of_degree(3));
  }
} // namespace PeriDeal
