// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/lac/full_matrix.h>

#include <perideal/analysis/coupling_certificate.h>
#include <perideal/operators/coupling/mesh_exchange.h>
#include <perideal/solvers/linear_solver.h>

#include "operator_test_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;

namespace
{
  const std::map<std::string, std::string> zones{
    {"block", "0.3 - max(abs(x - 0.5), abs(y - z - 0.25))"},
    {"random", "sin(4375.85*x + 1234.5*y + 777.7*z + 2) + 0.2"},
    {"half", "0.55 - x"},
    {"all", "everywhere"}};


  /**
   * A body with the values of a field on all of its sides, a source that belongs to it, and a zone.
   */
  template <int dim>
  Settings patch(const std::string &field,
                 const std::string &source,
                 const std::string &zone,
                 const bool         hole = false)
  {
    std::string sides = hole ? "hole: (" + field + "); " : "";
    for (unsigned int side = 0; side < 2 * dim; ++side)
      sides += box_side_names()[side] + ": (" + field + "); ";
    return {{"Boundary conditions/Dirichlet", sides},
            {"Initial and source/Source", source},
            {"Initial and source/Initial value", field},
            {"Time/Steady", "true"},
            {"Coupling/Zone", zone}};
  }


  /** Largest difference of the solution from the field, over the largest value of the field. */
  template <int dim>
  double patch_error(const Problem<dim> &problem)
  {
    const Expression &field = problem.scene.initial_and_source.initial_value;
    Vector exact = problem.values([&](const dealii::Point<dim> &p) { return field.value(p); });
    Vector e     = problem.vector();
    problem.op().distribute(exact, 0.);
    LinearSolver(problem.op(), 1e-6, 1000).solve(0., 1., e, problem.residual(exact));
    return e.linfty_norm() / exact.linfty_norm();
  }


  template <int dim>
  void check_linear(const Settings                 &shape,
                    const std::vector<std::string> &ratios = {"2", "3", "2.4"})
  {
    for (const auto &[name, zone] : zones)
      for (const std::string &m : ratios)
        {
          const Problem<dim> problem(
            shape + patch<dim>("1 + 2*x + 3*y - 2.5*z", "0", zone, shape.back().second == "0.23") +
              Settings{{"Peridynamics/Horizon ratio", m}},
            ModelKind::coupled);
          EXPECT_GT(problem.op().size().bonds, 0u);
          EXPECT_LT(patch_error(problem), 1e-13) << name << ", m = " << m;
          EXPECT_LT(examine_coupling(problem.op(), true).asymmetry, 1e-14) << name << ", m = " << m;
          EXPECT_GT(cells_of(problem.op()).lowest_remainder(), -1e-13) << name << ", m = " << m;
          Vector one = problem.values([](const dealii::Point<dim> &) { return 1.; }), image = one;
          problem.op().multiply(image, one);
          cells_of(problem.op()).hanging_nodes().set(image, 0.);
          EXPECT_LT(image.linfty_norm() / problem.op().diagonal().linfty_norm(), 1e-13) << name;
        }
  }


  Settings cells(const std::string &n, const std::string &upper)
  {
    return {{"Domain/Cells", n}, {"Domain/Upper corner", upper}};
  }
} // namespace


TEST(Exchange, linear_patch_1d)
{
  check_linear<1>(cells("20", "1"));
}


TEST(Exchange, linear_patch_2d)
{
  check_linear<2>(cells("16, 16", "1, 1"));
  check_linear<2>(cells("12, 18", "1, 0.5"), {"6", "7.5"}); // rectangles 1:3
}


TEST(Exchange, linear_patch_3d)
{
  check_linear<3>(cells("8, 8, 8", "1, 1, 1"));
  check_linear<3>(cells("5, 10, 8", "1, 1, 1"));
}


TEST(Exchange, linear_patch_around_holes)
{
  check_linear<2>(cells("16, 16", "1, 1") + Settings{{"Domain/Shape", "plate with hole"},
                                                     {"Domain/Hole center", "0.5, 0.5"},
                                                     {"Domain/Hole radius", "0.23"}});
}


TEST(Exchange, linear_patch_with_hanging_nodes)
{
  const auto graded = [](const std::string &levels) {
    return Settings{{"Domain/Coarsening", levels}, {"Domain/Fine where", "0.45 - x + 0.3*y - z"}};
  };
  check_linear<1>(cells("32", "1") + graded("1"));
  for (const std::string levels : {"1", "2"})
    check_linear<2>(cells("24, 24", "1, 1") + graded(levels));
  check_linear<2>(cells("16, 24", "1, 0.5") + graded("1"), {"6"}); // rectangles 1:3
  check_linear<3>(cells("8, 8, 8", "1, 1, 1") + graded("1"), {"2", "2.4"});
}


TEST(Exchange, linear_patch_with_bonds_across_levels)
{
  // Followed through the cells as on any mesh.
  for (const std::string m : {"2", "3.2"})
    {
      Problem<2> problem(cells("24, 24", "1, 1") + patch<2>("1 + 2*x + 3*y", "0", "everywhere") +
                           Settings{{"Domain/Coarsening", "1"},
                                    {"Domain/Fine where", "0.45 - x + 0.3*y"},
                                    {"Peridynamics/Horizon ratio", m}},
                         ModelKind::finite_elements);
      Nodes<2>   nodes(problem.handler,
                     problem.scene.domain,
                     problem.scene.cracks,
                     NodalVolume::partial);
      auto       bonds =
        std::make_unique<MeshExchange<2, ConductingBonds<2>>>(nodes, problem.scene, Zone<2>());
      problem.field = field_of_elements<2>(problem.handler, problem.scene, std::move(bonds));
      EXPECT_LT(patch_error(problem), 1e-13) << m;
      EXPECT_LT(examine_coupling(problem.op(), true).asymmetry, 1e-14) << m;
      EXPECT_GT(cells_of(problem.op()).lowest_remainder(), -1e-13) << m;
    }
}


TEST(Exchange, agrees_with_the_reference)
{
  // Bonds and largest eigenvalues that a plain form of the method gives on 16 x 16 cells, zone 5 <=
  // i <= 11, 4 <= j <= 12.
  const struct
  {
    const char  *m, *zone;
    unsigned int n_bonds;
    double       largest;
  } expected[] = {{"2", "min(3.5 - abs(x - 8), 4.5 - abs(y - 8))", 464, 4.604},
                  {"3", "min(3.5 - abs(x - 8), 4.5 - abs(y - 8))", 748, 3.946},
                  {"4", "min(3.5 - abs(x - 8), 4.5 - abs(y - 8))", 1174, 3.901},
                  {"2", "everywhere", 2526, 4.548},
                  {"3", "everywhere", 4348, 3.176},
                  {"4", "everywhere", 7634, 2.784}};
  for (const auto &[m, zone, n_bonds, largest] : expected)
    {
      const Problem<2> problem({{"Domain/Cells", "16, 16"},
                                {"Domain/Upper corner", "16, 16"},
                                {"Peridynamics/Horizon ratio", m},
                                {"Coupling/Zone", zone}},
                               ModelKind::coupled);
      EXPECT_EQ(problem.op().size().bonds, n_bonds) << m << ' ' << zone;
      // K itself: without its capacity, whose nodes on the sides are lighter.

      Vector x = problem.values(bumpy<2>), y = x;
      double norm = 0.;
      for (unsigned int k = 0; k < 3000; ++k)
        {
          x /= x.l2_norm();
          problem.op().multiply(y, x);
          norm = y.l2_norm();
          x.swap(y);
        }
      EXPECT_NEAR(norm, largest, 1.5e-3) << m << ' ' << zone;
    }
}


/** Bonds as a form of their own, or in the matrix: the same operator. */
TEST(Exchange, both_forms_agree)
{
  const Settings shape =
    cells("14, 17", "1.4, 1.7") + Settings{{"Cracks/Segments", "0.3,0.4 ; 0.92,1.21"},
                                           {"Cracks/Transmission", "0.3"},
                                           {"Boundary conditions/Dirichlet", "left: x + y"},
                                           {"Boundary conditions/Convection", "top: 3, 20"}};
  for (const char *correction : {"none", "crack scaling"})
    {
      const Settings   all = shape + Settings{{"Peridynamics/Surface correction", correction}};
      const Problem<2> form(all + Settings{{"Coupling/Zone", "everywhere"}}, ModelKind::coupled);
      const Problem<2> matrix(all + Settings{{"Coupling/Zone", "1"}}, ModelKind::coupled);
      EXPECT_EQ(form.op().size().form, "lattice");
      EXPECT_EQ(matrix.op().size().form, "matrix");
      EXPECT_EQ(form.op().size().bonds, matrix.op().size().bonds);
      const Vector a = form.residual(form.values(bumpy<2>)),
                   b = matrix.residual(matrix.values(bumpy<2>));
      EXPECT_LT(difference(form, a, matrix, b), 1e-13 * a.linfty_norm());
      EXPECT_LT(difference(form, form.op().diagonal(), matrix, matrix.op().diagonal()), 1e-13);
    }
}


/** A crack through the whole body is a resistance in series, with crack scaling, too. */
TEST(Exchange, scaled_contact_conductance)
{
  const auto flux = [](const std::string &zone, const double H, const std::string &correction) {
    const Problem<2> problem(cells("20, 21", "1, 1.05") +
                               Settings{{"Cracks/Segments", "-1,0.52 ; 2,0.52"},
                                        {"Cracks/Contact conductance", std::to_string(H)},
                                        {"Peridynamics/Surface correction", correction},
                                        {"Coupling/Zone", zone},
                                        {"Boundary conditions/Dirichlet", "bottom: 0 ; top: 1"}},
                             ModelKind::coupled);
    return problem.op().balance(problem.steady(), 0., true).sides.at("top");
  };
  for (const std::string zone : {"everywhere", "cracks: 1"})
    {
      EXPECT_NEAR(flux(zone, 0., "crack scaling"), 0., 1e-10) << zone;
      for (const double H : {0.4, 4., 40.})
        {
          const double exact = 1. / (1.05 + 1. / H);
          EXPECT_NEAR(flux(zone, H, "crack scaling"), exact, 0.025 * exact) << zone << ", " << H;
        }
      EXPECT_NEAR(flux(zone, 1e12, "crack scaling"), flux(zone, 1e12, "none"), 1e-10) << zone;
    }
}


/** Far from the sides peridynamics by exchange is peridynamics. */
TEST(Exchange, equals_bonds_alone_inside)
{
  const Settings   shape = cells("20, 20", "1, 1");
  const Problem<2> exchange(shape + Settings{{"Coupling/Zone", "everywhere"}}, ModelKind::coupled);
  const Problem<2> alone(shape + Settings{{"Peridynamics/Boundary treatment", "none"}});
  Vector a = exchange.product(exchange.values(bumpy<2>)), b = alone.product(alone.values(bumpy<2>));
  const auto inside = [](const dealii::Point<2> &p) {
    return std::max(std::abs(p[0] - 0.5), std::abs(p[1] - 0.5)) < 0.3;
  };
  for (auto [problem, v] : {std::pair(&exchange, &a), std::pair(&alone, &b)})
    for (unsigned int i = 0; i < v->locally_owned_size(); ++i)
      v->local_element(i) *= inside(problem->positions[i]);
  EXPECT_GT(a.linfty_norm(), 1e-3);
  EXPECT_LT(difference(exchange, a, alone, b), 1e-13);
}


TEST(Exchange, layers_and_graded_materials)
{
  // Two layers: bonds across the jump are not active, so the exact solution, linear in each, comes
  // out.
  for (const char *ratio : {"10", "1000"})
    {
      const std::string r = ratio;
      const Problem<2>  layers(
        cells("16, 16", "1, 1") +
          Settings{{"Material/Conductivity", "x < 0.5 ? 1 : " + r},
                   {"Boundary conditions/Dirichlet", "left: 0; right: 1"},
                   {"Initial and source/Initial value",
                     "(x < 0.5 ? " + r + " * x : x - 0.5 + " + r + " / 2) * 2 / (1 + " + r + ")"},
                   {"Time/Steady", "true"},
                   {"Coupling/Zone", "everywhere"}},
        ModelKind::coupled);
      EXPECT_LT(patch_error(layers), 1e-12) << ratio;
    }
  // Conductivity 1 + x, T = log(1 + x).
  double last = 0.;
  for (const char *n : {"16, 16", "32, 32", "64, 64"})
    {
      const Problem<2> graded(cells(n, "1, 1") +
                                Settings{{"Material/Conductivity", "1 + x"},
                                         {"Boundary conditions/Dirichlet", "left: 0; right: ln(2)"},
                                         {"Initial and source/Initial value", "ln(1 + x)"},
                                         {"Time/Steady", "true"},
                                         {"Coupling/Zone", "everywhere"}},
                              ModelKind::coupled);
      const double     error = patch_error(graded);
      if (last > 0.)
        {
          EXPECT_LT(error, last / 3.2);
        }
      last = error;
    }
}


TEST(Couplings, splice_is_exact_for_quadratics)
{
  const Problem<2> problem(
    cells("20, 20", "1, 1") +
      patch<2>("x^2 + x*y - 2*y^2", "2", "0.22 - max(abs(x - 0.5), abs(y - 0.5))") +
      Settings{{"Coupling/Scheme", "splice"}},
    ModelKind::coupled);
  EXPECT_LT(patch_error(problem), 1e-12);
  const CouplingCertificate found = examine_coupling(problem.op(), false);
  EXPECT_LT(found.quadratic, 1e-12);
  EXPECT_LT(found.cubic, 1e-12); // since families are symmetric
  EXPECT_GT(found.asymmetry, 1e-3);
}


TEST(Couplings, blending_is_symmetric_but_not_exact)
{
  double last = 0.;
  for (const char *overlap : {"0", "1", "2"})
    {
      const Problem<2> problem(
        cells("40, 40", "1, 1") +
          Settings{{"Coupling/Zone", "0.2 - max(abs(x - 0.5), abs(y - 0.5))"},
                   {"Coupling/Scheme", "blending"},
                   {"Coupling/Overlap", overlap}},
        ModelKind::coupled);
      const CouplingCertificate found = examine_coupling(problem.op(), true);
      EXPECT_LT(found.asymmetry, 1e-14);
      EXPECT_GT(found.linear, 1e-5);
      EXPECT_LT(found.linear, 2e-2);
      EXPECT_FALSE(found.fault().empty());
      EXPECT_NE(found.linear, last) << "the overlap has no effect";
      last = found.linear;
    }
}


TEST(Couplings, certificate_of_exchange)
{
  const Problem<2>          problem(cells("24, 24", "1, 1") +
                             Settings{{"Cracks/Segments", "0.3,0.4 ; 0.7,0.55"},
                                      {"Boundary conditions/Dirichlet", "left: 1"}},
                           ModelKind::coupled);
  const CouplingCertificate found = examine_coupling(problem.op(), true);
  EXPECT_EQ(found.fault(), "");
  EXPECT_LT(found.linear, 1e-13);
  EXPECT_GT(found.quadratic, 1e-8);
  EXPECT_GT(found.cubic, 1e-8);
  EXPECT_LT(found.asymmetry, 1e-14);
  EXPECT_GT(found.lowest_remainder, -1e-13);
  EXPECT_NEAR(found.lowest_eigenvalue,
              2. * std::pow(std::acos(-1.), 2),
              0.1); // of the square held all around
  EXPECT_GT(found.zone_share, 0.1);
  EXPECT_LT(found.zone_share, 0.4);
  const Problem<2> full(cells("24, 24", "1, 1") +
                        Settings{{"Peridynamics/Boundary treatment", "none"}});
  EXPECT_EQ(found.n_bonds_of_full, full.op().size().bonds);
}


TEST(Exchange, higher_patches_converge)
{
  for (const auto &[name, zone] : zones)
    {
      double last_quadratic = 0., last_cubic = 0.;
      for (const char *n : {"12, 12", "24, 24"})
        {
          // A random zone has another pattern on another mesh.
          const Problem<2> quadratic(cells(n, "1, 1") + patch<2>("x^2 + x*y - 2*y^2", "2", zone),
                                     ModelKind::coupled);
          const Problem<2> cubic(cells(n, "1, 1") +
                                   patch<2>("x^3 - y^2*x + y^3", "-4*x - 6*y", zone),
                                 ModelKind::coupled);
          const double     a = patch_error(quadratic), b = patch_error(cubic);
          if (last_quadratic > 0.)
            {
              EXPECT_LT(a, 0.5 * last_quadratic) << name;
              EXPECT_LT(b, 0.5 * last_cubic) << name;
            }
          last_quadratic = a;
          last_cubic     = b;
        }
    }
}
