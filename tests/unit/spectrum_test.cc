// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/operators/bounds/spectrum.h>
#include <perideal/solvers/linear_solver.h>

#include <numeric>

#include "operator_test_tools.h"
#include "scene_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using dealii::Point;

  namespace
  {
    /** sharp is above the largest eigenvalue, by less than the slack, and not above safe. */
    template <int dim>
    void expect_bounds(const std::string &what,
                       const Settings    &settings,
                       const double       slack,
                       const ModelKind    model = ModelKind::peridynamics)
    {
      const Problem<dim>    problem(settings, model);
      const Spectrum        spectrum = problem.op().spectrum();
      const DenseProperties matrix(problem.op());
      EXPECT_LE(spectrum.sharp, spectrum.safe) << what;
      EXPECT_GE(spectrum.sharp, matrix.largest * (1. - 1e-12)) << what;
      EXPECT_LE(spectrum.sharp, matrix.largest * (1. + slack)) << what;
    }


    unsigned int iterations(const unsigned int cells, const Settings &more)
    {
      const std::string n = std::to_string(cells);
      const Problem<2>  problem(
        more + Settings{{"Domain/Cells", n + "," + n}, {"Peridynamics/Horizon ratio", "6.5"}});
      Vector u = problem.vector();
      return solve_steady(problem.op(), u, 0., 1e-10, 1000);
    }
  } // namespace


  TEST(Spectrum, bounds_of_symmetric_operators)
  {
    const Settings plate{{"Domain/Cells", "14, 12"}};
    const Settings sides{{"Boundary conditions/Dirichlet", "left: 0 ; top: 1"}};
    const Settings crack{{"Cracks/Segments", "0.2,0.31 ; 0.71,0.52"},
                         {"Peridynamics/Surface correction", "crack scaling"}};
    const Settings wide{{"Peridynamics/Horizon", "0.4"}};
    for (const std::string kernel : {"constant", "conical", "gaussian"})
      for (const std::string placement : {"vertices", "cell centers"})
        {
          const Settings base =
            plate + wide + Settings{{"Peridynamics/Kernel", kernel}, {"Domain/Nodes", placement}};
          const std::string what = kernel + ", " + placement;
          expect_bounds<2>(what, base, 0.02);
          expect_bounds<2>(what + ", sides", base + sides, 0.02);
          expect_bounds<2>(what + ", crack", base + sides + crack, 0.02);
          expect_bounds<2>(what + ", mirror",
                           base + sides +
                             Settings{{"Peridynamics/Boundary treatment", "fictitious mirror"},
                                      {"Boundary conditions/Symmetry", "right"}},
                           0.02);
          expect_bounds<2>(what + ", convection",
                           base + Settings{{"Boundary conditions/Convection", "left: 1000, 1"}},
                           0.02);
        }
    expect_bounds<1>("bar",
                     {{"Domain/Cells", "50"}, {"Boundary conditions/Dirichlet", "left: 0"}},
                     0.02);
    expect_bounds<3>("brick",
                     {{"Domain/Cells", "6, 5, 5"}, {"Peridynamics/Horizon", "0.45"}},
                     0.02);
    expect_bounds<2>("elements", plate + sides, 0.02, ModelKind::finite_elements);
    expect_bounds<2>("elements, crack", plate + sides + crack, 0.02, ModelKind::finite_elements);
    expect_bounds<2>("heavy on the right",
                     plate + Settings{{"Material/Density", "1 + 1000*(x > 0.5)"}},
                     0.02);
  }


  TEST(Spectrum, bounds_of_nonsymmetric_operators)
  {
    const Settings plate{{"Domain/Cells", "14, 12"}};
    expect_bounds<2>("slaves",
                     plate + Settings{{"Boundary conditions/Dirichlet", "left: 0"},
                                      {"Boundary conditions/Flux", "right: 0 ; top: 0 ; bottom: 0"},
                                      {"Peridynamics/Flux treatment", "extrapolation"}},
                     0.08);
    expect_bounds<2>("self term",
                     plate + Settings{{"Boundary conditions/Dirichlet", "left: 0"},
                                      {"Peridynamics/Self term", "paper"}},
                     0.08);
    expect_bounds<1>("layer",
                     {{"Domain/Cells", "40"},
                      {"Boundary conditions/Dirichlet", "left: 0"},
                      {"Boundary conditions/Flux", "right: 0"},
                      {"Peridynamics/Flux treatment", "layer extrapolation"}},
                     0.08);
  }


  TEST(Spectrum, rounded_up_to_three_digits)
  {
    EXPECT_DOUBLE_EQ(round_up(123.4), 124.);
    EXPECT_DOUBLE_EQ(round_up(124.), 124.);
    EXPECT_DOUBLE_EQ(round_up(0.012341), 0.0124);
    EXPECT_DOUBLE_EQ(round_up(0.), 0.);
  }


  TEST(LinearSolver, iterations_do_not_grow_with_the_number_of_nodes)
  {
    const Settings sides{{"Boundary conditions/Dirichlet", "bottom: -100 ; top: 100"}};
    const Settings crack{{"Cracks/Segments", "0.25,0.501 ; 0.75,0.501 ; 0.4,0.2 ; 0.55,0.4"}};
    for (const unsigned int cells : {60, 120, 240})
      {
        EXPECT_LE(iterations(cells, sides), 20u) << cells;
        EXPECT_LE(iterations(cells, sides + crack), 20u) << cells << ", cracked";
      }
  }


  TEST(LinearSolver, treatments_and_materials)
  {
    const Settings sides{{"Boundary conditions/Dirichlet", "bottom: -100 ; top: 100"}};
    const Settings centers{{"Domain/Nodes", "cell centers"}};
    for (const std::string treatment : {"layer", "fictitious mirror", "fictitious constant"})
      for (const Settings &placement : {Settings(), centers})
        EXPECT_LE(
          iterations(60,
                     sides + placement + Settings{{"Peridynamics/Boundary treatment", treatment}}),
          22u)
          << treatment;
    EXPECT_LE(
      iterations(60,
                 centers + Settings{{"Peridynamics/Boundary treatment", "fictitious mirror"},
                                    {"Boundary conditions/Dirichlet", "bottom: 1"},
                                    {"Boundary conditions/Symmetry", "left, right, top"}}),
      22u);
    EXPECT_LE(iterations(60, Settings{{"Boundary conditions/Convection", "left: 5, 3"}}), 25u);
    // A jump of conductivity by a thousand.
    for (const std::string rule : {"minimum", "arithmetic", "harmonic"})
      EXPECT_LE(iterations(60,
                           sides + Settings{{"Material/Conductivity", "1 + 999*(x > 0.5)"},
                                            {"Material/Interface rule", rule}}),
                150u)
        << rule;
    // Nonsymmetric: GMRES.
    EXPECT_LE(iterations(60,
                         Settings{{"Boundary conditions/Dirichlet", "left: 1"},
                                  {"Boundary conditions/Flux", "right: 0 ; bottom: 0 ; top: 1"},
                                  {"Peridynamics/Flux treatment", "extrapolation"}}),
              60u);
  }


  TEST(LinearSolver, errors)
  {
    const Problem<2> insulated(Settings{{"Domain/Cells", "8, 8"}});
    Vector           u = insulated.vector();
    SceneTests::expect_error([&] { solve_steady(insulated.op(), u, 0., 1e-10, 100); },
                             {"'Steady = true'", "'Dirichlet'"});
    const Problem<2> plate(
      {{"Domain/Cells", "20, 20"}, {"Boundary conditions/Dirichlet", "left: 0 ; right: y"}});
    Vector v = plate.vector();
    SceneTests::expect_error([&] { solve_steady(plate.op(), v, 0., 1e-10, 2); },
                             {"'Tolerance'", "'Maximum iterations'", "'Solver'"});
    // From the solution itself nothing is left to do.
    solve_steady(plate.op(), v = 0., 0., 1e-12, 100);
    const Vector once(v);
    solve_steady(plate.op(), v, 0., 1e-6, 100);
    EXPECT_LT(largest_difference(v, once), 1e-11);
  }


  TEST(Spectrum, kept_until_rates_grow)
  {
    const Problem<2> problem(
      {{"Domain/Cells", "8, 8"}, {"Boundary conditions/Dirichlet", "left: 0"}},
      ModelKind::finite_elements);
    const Operator           &op   = problem.op();
    const double              safe = op.spectrum().safe, sharp = op.spectrum().sharp;
    SpectralBounds            bounds(op, [&](Vector &v) {
      for (unsigned int i = 0; i < v.locally_owned_size(); ++i)
        v.local_element(i) = position_noise(problem.positions[i]);
    });
    std::vector<unsigned int> rows(problem.positions.size());
    std::iota(rows.begin(), rows.end(), 0);
    const auto not_asked = [](const double) -> double {
      ADD_FAILURE();
      return 0.;
    };
    bounds.set(0.5 * safe);
    bounds.raise(safe, rows, not_asked); // nobody knows the sharp bound yet
    EXPECT_EQ(bounds.safe(), safe);
    EXPECT_EQ(bounds.get().sharp, sharp);
    EXPECT_EQ(bounds.get().safe, safe);
    const auto n = op.n_applications();
    bounds.get();
    EXPECT_EQ(op.n_applications(), n);
    // A local bound counts where it is larger, rounded up and not above the safe one.
    const auto raised = [&](const double gershgorin, const double local) {
      bounds.raise(gershgorin, rows, [&](const double enough) {
        EXPECT_EQ(enough, bounds.get().sharp);
        return local;
      });
      return bounds.get();
    };
    EXPECT_EQ(raised(0., 0.5 * sharp).sharp, sharp);
    EXPECT_EQ(raised(0., 100. * safe).sharp, safe);
    EXPECT_EQ(raised(3. * safe, 2. * safe).sharp, round_up(2. * safe));
    EXPECT_EQ(bounds.safe(), 3. * safe);
    EXPECT_EQ(op.n_applications(), n);
    // Where there is none iterations on the operator itself are asked, from noise in the rows.
    bounds.set(safe);
    EXPECT_EQ(bounds.get().sharp, sharp);
    const auto before = op.n_applications();
    EXPECT_EQ(raised(0., -1.).sharp, sharp);
    EXPECT_GT(op.n_applications(), before);
  }
} // namespace PeriDeal
