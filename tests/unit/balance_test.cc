// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "operator_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using dealii::Point;

  namespace
  {
    const Settings plate{{"Domain/Cells", "20, 16"},
                         {"Domain/Upper corner", "1, 0.8"},
                         {"Initial and source/Source", "2 - 7*x*y"}};
    const Settings sides{{"Boundary conditions/Dirichlet", "left: 1 + y ; bottom: cos(3*x)"},
                         {"Boundary conditions/Flux", "top: 3*x"},
                         {"Boundary conditions/Convection", "right: 4 + y, 2"}};
    const Settings crack{{"Cracks/Segments", "0,0.41 ; 0.43,0.55 ; 0.55,0 ; 0.71,0.3"}};
    const Settings symmetric{{"Boundary conditions/Dirichlet", "left: 1 + y ; bottom: cos(3*x)"},
                             {"Boundary conditions/Symmetry", "right, top"}};


    /**
     * entering() is what the balance says of sides and sources, with and without finish(), and
     * linear in the field but for loads.
     */
    template <int dim>
    void expect_entering(const std::string &what, const Problem<dim> &problem, const Vector &u)
    {
      const DiffusionOperator &op      = problem.op();
      const Balance            balance = op.balance(u, 0.7, false);
      double                   heat = balance.sources, size = std::abs(balance.sources);
      for (const auto &[name, value] : balance.sides)
        {
          heat += value;
          size += std::abs(value);
        }
      Vector x = problem.values([](const Point<dim> &p) { return std::cos(3. * p[0]) - p[0]; }),
             y = problem.vector(), sum = u;
      const auto entering = [&] { return sum_of_all(op.entering()); };
      op.residual(y, u, 0.7);
      const double alone = entering();
      EXPECT_NEAR(alone, heat, 1e-11 * size) << what;
      op.residual_then(y, u, 0.7, [](const unsigned int, const unsigned int) {});
      EXPECT_NEAR(entering(), heat, 1e-11 * size) << what;
      op.distribute_homogeneous(x);
      sum += x;
      op.distribute(sum, 0.7);
      op.residual(y, sum, 0.7);
      const double both = entering();
      op.apply(y, x);
      EXPECT_NEAR(entering(), both - alone, 1e-11 * (size + std::abs(both))) << what;
    }


    /**
     * Nothing is lost: in a field that is no solution at all, and in a steady one, to 1e-12 of what
     * flows.
     */
    template <int dim>
    void expect_balance(const std::string &what,
                        const Settings    &settings,
                        const ModelKind    model = ModelKind::peridynamics)
    {
      const Problem<dim> problem(settings, model);
      ASSERT_TRUE(problem.op().symmetric()) << what;
      Vector u = problem.values(bumpy<dim>);
      problem.op().distribute(u, 0.7);
      const Balance moving = problem.op().balance(u, 0.7, false);
      double        size   = std::abs(moving.stored) + std::abs(moving.sources);
      for (const auto &[name, heat] : moving.sides)
        size += std::abs(heat);
      EXPECT_GT(size, 0.1) << what;
      EXPECT_LT(std::abs(moving.imbalance()), 1e-12 * size) << what;
      expect_entering(what, problem, u);

      const Balance steady = problem.op().balance(problem.steady(1e-14, u), 0., true);
      EXPECT_GT(steady.throughput(), 0.1) << what;
      EXPECT_LT(std::abs(steady.imbalance()), 1e-12 * steady.throughput()) << what;
    }
  } // namespace


  TEST(Balance, through_sides_beside_symmetry)
  {
    // A linear field, exact with mirrored layers: all heat goes through the two sides with values,
    // none through the others.
    for (const std::string placement : {"vertices", "cell centers"})
      for (const bool upright : {true, false})
        {
          const std::string hot = upright ? "top" : "left", cold = upright ? "bottom" : "right",
                            beside = upright ? "left; right" : "bottom; top";
          const Problem<2> problem({{"Domain/Cells", "12, 12"},
                                    {"Domain/Nodes", placement},
                                    {"Peridynamics/Boundary treatment", "fictitious mirror"},
                                    {"Boundary conditions/Dirichlet", hot + ": 3; " + cold + ": 1"},
                                    {"Boundary conditions/Symmetry", beside}},
                                   ModelKind::peridynamics);
          Vector           u = problem.values(
            [&](const Point<2> &p) { return upright ? 1. + 2. * p[1] : 3. - 2. * p[0]; });
          problem.op().distribute(u, 0.);
          const Balance balance = problem.op().balance(u, 0., true);
          ASSERT_EQ(balance.sides.size(), 4u);
          for (const auto &[name, heat] : balance.sides)
            {
              const double wanted = name == hot ? 2. : name == cold ? -2. : 0.;
              EXPECT_NEAR(heat, wanted, 1e-12) << name;
            }
        }
  }


  TEST(Balance, peridynamics)
  {
    for (const std::string placement : {"vertices", "cell centers"})
      for (const std::string treatment :
           {"none", "layer", "fictitious mirror", "fictitious constant"})
        {
          const Settings    base = plate + Settings{{"Domain/Nodes", placement},
                                                 {"Peridynamics/Boundary treatment", treatment},
                                                 {"Peridynamics/Layer rows", "3"}};
          const std::string what = placement + ", " + treatment;
          if (placement == "cell centers" && treatment == "none")
            continue; // the row of cells on the side is prescribed: nothing new
          expect_balance<2>(what, base + sides);
          expect_balance<2>(what + ", cracks", base + sides + crack);
          expect_balance<2>(what + ", symmetry", base + symmetric);
          expect_balance<2>(what + ", symmetry, cracks",
                            base + symmetric + crack +
                              Settings{{"Peridynamics/Surface correction", "crack scaling"},
                                       {"Cracks/Transmission", "0.2"}});
        }
  }


  TEST(Balance, peridynamics_other_dimensions)
  {
    expect_balance<1>("bar",
                      {{"Domain/Cells", "30"},
                       {"Peridynamics/Boundary treatment", "fictitious mirror"},
                       {"Boundary conditions/Dirichlet", "left: 1"},
                       {"Boundary conditions/Flux", "right: 3"},
                       {"Initial and source/Source", "x"}});
    expect_balance<3>("brick",
                      {{"Domain/Cells", "7, 6, 5"},
                       {"Peridynamics/Horizon", "0.41"},
                       {"Boundary conditions/Dirichlet", "left: 1"},
                       {"Boundary conditions/Convection", "front: 3, 2"},
                       {"Initial and source/Source", "x"}});
    expect_balance<2>("varying conductivity",
                      plate + sides + crack +
                        Settings{{"Material/Conductivity", "1 + x + 4*(y > 0.4)"},
                                 {"Material/Interface rule", "harmonic"}});
  }


  TEST(Balance, finite_elements)
  {
    for (const std::string mesh : {"pairs", "removed"})
      expect_balance<2>(
        mesh,
        plate + sides +
          Settings{{"Cracks/Mesh", mesh}, {"Cracks/Segments", "0.21,0.41 ; 0.43,0.55"}},
        ModelKind::finite_elements);
    expect_balance<2>("scaled",
                      plate + sides + crack +
                        Settings{{"Peridynamics/Surface correction", "crack scaling"}},
                      ModelKind::finite_elements);
    expect_balance<2>("faces",
                      plate + sides +
                        Settings{{"Cracks/Mesh", "faces"}, {"Cracks/Segments", "-1,0.4 ; 0.5,0.4"}},
                      ModelKind::finite_elements);
    for (const std::string degree : {"2", "3"})
      expect_balance<2>("Q" + degree,
                        plate + sides + Settings{{"Finite elements/Degree", degree}},
                        ModelKind::finite_elements);
    expect_balance<1>("bar",
                      {{"Domain/Cells", "30"},
                       {"Boundary conditions/Dirichlet", "left: 1"},
                       {"Boundary conditions/Convection", "right: 3, 5"},
                       {"Initial and source/Source", "x"}},
                      ModelKind::finite_elements);
    expect_balance<3>("brick",
                      {{"Domain/Cells", "5, 4, 3"},
                       {"Boundary conditions/Dirichlet", "left: 1"},
                       {"Boundary conditions/Convection", "right: 3, 5"},
                       {"Initial and source/Source", "x"}},
                      ModelKind::finite_elements);
  }


  TEST(Balance, entering_with_values_that_follow_from_others)
  {
    // What extrapolated fluxes and the papers' self term do not conserve enters all the same.
    for (const Settings &more :
         {Settings{{"Peridynamics/Flux treatment", "extrapolation"}},
          Settings{{"Peridynamics/Self term", "paper"},
                   {"Peridynamics/Boundary treatment", "fictitious mirror"}}})
      {
        const Problem<2> problem(plate +
                                   Settings{{"Boundary conditions/Dirichlet", "left: 1 + y*t"},
                                            {"Boundary conditions/Flux", "top: 3*x; right: t"}} +
                                   more,
                                 ModelKind::peridynamics);
        Vector           u = problem.values(bumpy<2>);
        problem.op().distribute(u, 0.7);
        expect_entering(more[0].second, problem, u);
      }
  }


  TEST(Balance, bar_carries_what_enters)
  {
    // Steady bar: flux 3 in on the right, source x, temperature 1 on the left: everything leaves on
    // the left.
    for (const ModelKind model : {ModelKind::peridynamics, ModelKind::finite_elements})
      {
        const Problem<1> problem({{"Domain/Cells", "40"},
                                  {"Material/Conductivity", "2"},
                                  {"Boundary conditions/Dirichlet", "left: 1"},
                                  {"Boundary conditions/Flux", "right: 3"},
                                  {"Initial and source/Source", "x"}},
                                 model);
        const Vector     u       = problem.steady(1e-13);
        const Balance    balance = problem.op().balance(u, 0., true);
        EXPECT_NEAR(balance.sides.at("right"), 3., 1e-12);
        EXPECT_NEAR(balance.sources, 0.5, 1e-12);
        // The natural side of the prescribed node holds no source of its own in PD: it is not
        // counted either.
        EXPECT_NEAR(balance.sides.at("left"), -3.5, 1e-9);
        EXPECT_NEAR(balance.throughput(), 3.5, 1e-12);
        if (model == ModelKind::finite_elements)
          {
            // Exact at the vertices: 2 T'' = -x, 2 T'(1) = 3.
            const Vector exact = problem.values(
              [](const Point<1> &p) { return 1. + 1.75 * p[0] - p[0] * p[0] * p[0] / 12.; });
            EXPECT_LT(largest_difference(u, exact), 1e-11);
          }
      }
  }
} // namespace PeriDeal
