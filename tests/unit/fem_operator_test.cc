// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/solvers/linear_solver.h>

#include "operator_test_tools.h"
#include "scene_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using dealii::Point;

  namespace
  {
    /** A linear field given on the whole boundary comes out inside. */
    template <int dim>
    void expect_patch_test(const Settings &settings)
    {
      const std::string formula[] = {"", "1 + 2*x", "1 + 2*x - y", "1 + 2*x - y + 3*z"};
      std::string       dirichlet;
      for (unsigned int s = 0; s < 2 * dim; ++s)
        dirichlet += (s > 0 ? ";" : "") + box_side_names()[s] + ": " + formula[dim];
      const Problem<dim> problem(settings + Settings{{"Boundary conditions/Dirichlet", dirichlet}},
                                 ModelKind::finite_elements);
      Vector             u = problem.vector();
      solve_steady(problem.op(), u, 0., 1e-14, 1000);
      const Vector exact = problem.values([](const Point<dim> &p) {
        return 1. + 2. * p[0] - (dim > 1 ? p[dim > 1] : 0.) + (dim > 2 ? 3. * p[dim - 1] : 0.);
      });
      EXPECT_LT(largest_difference(u, exact), 1e-12) << dim;
    }


    /** Conservation, symmetry, definiteness without Dirichlet sides; returns the matrix. */
    template <int dim>
    dealii::FullMatrix<double> checked_matrix(const Settings &settings, const std::string &what)
    {
      const Problem<dim>    problem(settings, ModelKind::finite_elements);
      const DenseProperties matrix(problem.op());
      EXPECT_LT(matrix.asymmetry, 1e-14) << what;
      EXPECT_GT(matrix.smallest, -1e-12 * matrix.largest) << what;
      Vector one = problem.vector(), y = problem.vector();
      one = 1.;
      problem.op().apply(y, one);
      EXPECT_LT(y.linfty_norm(), 1e-13 * matrix.entry) << what;
      return dense(problem.op());
    }
  } // namespace


  TEST(FiniteElements, patch_test)
  {
    expect_patch_test<1>({{"Domain/Cells", "7"}});
    expect_patch_test<2>({{"Domain/Cells", "6, 5"}});
    expect_patch_test<2>({{"Domain/Cells", "6, 5"}, {"Finite elements/Degree", "3"}});
    expect_patch_test<3>({{"Domain/Cells", "4, 3, 4"}});
  }


  TEST(FiniteElements, pairs_do_not_conduct_through_a_crack)
  {
    // Right through the body, between rows of nodes and along one: halves that know nothing of each
    // other.
    for (const std::string height : {"0.47", "0.5"})
      {
        const Settings   settings{{"Domain/Cells", "8, 8"},
                                {"Cracks/Segments", "-1," + height + " ; 2," + height}};
        const Problem<2> problem(settings, ModelKind::finite_elements);
        Vector above = problem.values([](const auto &p) { return p[1] > 0.49 ? 1. : 0.; }),
               y     = problem.vector();
        problem.op().apply(y, above);
        EXPECT_LT(y.linfty_norm(), 1e-14) << height;
        checked_matrix<2>(settings, height);
        unsigned int n_cut = 0;
        for (const auto &cell : problem.handler.active_cell_iterators())
          if (cell->is_locally_owned() && problem.fem->cut_cells()[cell->active_cell_index()])
            ++n_cut;
        EXPECT_EQ(dealii::Utilities::MPI::sum(n_cut, MPI_COMM_WORLD), 8u);
      }
    checked_matrix<3>({{"Domain/Cells", "4, 4, 4"},
                       {"Cracks/Polygons", "0.1,0.1,0.4 ; 0.8,0.1,0.4 ; 0.8,0.8,0.6 ; 0.1,0.8,0.6"},
                       {"Peridynamics/Surface correction", "crack scaling"}},
                      "3D");
    checked_matrix<2>({{"Domain/Cells", "8, 8"}, {"Cracks/Segments", "0.2,0.3 ; 0.7,0.6"}},
                      "oblique");
  }


  TEST(FiniteElements, pairs_with_contact_conductance)
  {
    // Steady heat through a body cut in half by a contact: resistances in series, R = 1/kappa (1 -
    // h) + (h/kappa + 1/H) of the row of cut cells.
    for (const std::string given : {"Contact conductance", "Transmission"})
      {
        const double     H = 3.;
        const Problem<2> problem({{"Domain/Cells", "9, 9"},
                                  {"Material/Conductivity", "2"},
                                  {"Cracks/Segments", "-1,0.48 ; 2,0.48"},
                                  {"Cracks/" + given, given == "Transmission" ? "0.4" : "3"},
                                  {"Boundary conditions/Dirichlet", "bottom: 0 ; top: 1"}},
                                 ModelKind::finite_elements);
        Vector           u = problem.vector();
        solve_steady(problem.op(), u, 0., 1e-13, 1000);
        const double flux = problem.op().balance(u, 0., true).sides.at("top");
        EXPECT_LT(flux, 2.);
        EXPECT_GT(flux, 0.2);
        if (given == "Contact conductance")
          {
            // Pairs of Q1 squares: edges kappa/6 each side, diagonals kappa/3, all scaled by H h/(H
            // h + kappa).
            EXPECT_NEAR(flux, 1. / (1. / 2. + 1. / H), 1e-10);
          }
      }
  }


  TEST(FiniteElements, scaled_pairs_with_contact_conductance)
  {
    // The pairs across the crack conduct as the conductance says, whatever the factors; the rows of
    // cells on both sides conduct (1 + g)/2 times as much.
    const double kappa = 2., h = 1. / 9.;
    for (const double H : {0.4, 3., 40., 1e12})
      {
        const Problem<2> problem({{"Domain/Cells", "9, 9"},
                                  {"Material/Conductivity", "2"},
                                  {"Cracks/Segments", "-1,0.48 ; 2,0.48"},
                                  {"Cracks/Contact conductance", std::to_string(H)},
                                  {"Peridynamics/Surface correction", "crack scaling"},
                                  {"Boundary conditions/Dirichlet", "bottom: 0 ; top: 1"}},
                                 ModelKind::finite_elements);
        Vector           u = problem.vector();
        solve_steady(problem.op(), u, 0., 1e-13, 1000);
        const double flux = problem.op().balance(u, 0., true).sides.at("top");
        // In units of kappa V: 2 expected, 1 of the whole cells, 1/6 of the pairs along the crack,
        // 5/6 t of those across it.
        const double t = H * h / (H * h + kappa), across = 5. / 6. * t,
                     g = 1. + (1. - t) * (1. - t) * ((2. - across) / (7. / 6.) - 1.);
        EXPECT_NEAR(flux,
                    1. / ((1. - 3. * h) / kappa + 4. * h / (kappa * (1. + g)) + h / kappa + 1. / H),
                    1e-9)
          << H;
      }
  }


  TEST(FiniteElements, faces_split_the_body)
  {
    const Problem<2> halves(
      {{"Domain/Cells", "8, 8"}, {"Cracks/Mesh", "faces"}, {"Cracks/Segments", "-1,0.5 ; 2,0.5"}},
      ModelKind::finite_elements);
    Vector above = halves.vector(), y = halves.vector();
    for (unsigned int i = 0; i < above.locally_owned_size(); ++i)
      above.local_element(i) = halves.sides[i][1] > 0.5 ? 1. : 0.;
    EXPECT_NEAR(above.l1_norm(), 45., 1e-12);
    halves.op().apply(y, above);
    EXPECT_LT(y.linfty_norm(), 1e-14);

    checked_matrix<3>({{"Domain/Cells", "4, 4, 4"},
                       {"Cracks/Mesh", "faces"},
                       {"Cracks/Polygons", "0,0.25,0.5 ; 0.75,0.25,0.5 ; 0.75,1,0.5 ; 0,1,0.5"}},
                      "3D");
  }


  TEST(FiniteElements, removed_cells_conduct_nothing)
  {
    const Problem<2> problem({{"Domain/Cells", "8, 8"},
                              {"Cracks/Mesh", "removed"},
                              {"Cracks/Segments", "-1,0.47 ; 2,0.47"}},
                             ModelKind::finite_elements);
    Vector           above = problem.values([](const auto &p) { return p[1] > 0.47 ? 1. : 0.; }),
           y               = problem.vector();
    problem.op().apply(y, above);
    EXPECT_LT(y.linfty_norm(), 1e-14);
    // Two cracks, one in each of two neighbouring rows of cells: the nodes between have no cell
    // left.
    const std::string message = SceneTests::message_of([] {
      Problem<2>({{"Domain/Cells", "8, 8"},
                  {"Cracks/Mesh", "removed"},
                  {"Cracks/Segments", "-1,0.47 ; 2,0.47 ; -1,0.55 ; 2,0.55"}},
                 ModelKind::finite_elements);
    });
    SceneTests::expect_parts(message, {"'Mesh'", "'Cracks'", "without any conducting cell"});
  }


  TEST(FiniteElements, capacity)
  {
    for (const std::string kind : {"lumped", "consistent"})
      {
        const Problem<2> problem({{"Domain/Cells", "6, 6"},
                                  {"Material/Density", "2 + x"},
                                  {"Finite elements/Capacity", kind}},
                                 ModelKind::finite_elements);
        Vector           one = problem.vector(), y = problem.vector();
        one = 1.;
        problem.op().apply_capacity(y, one);
        EXPECT_NEAR(y.l1_norm(), 2.5, 1e-13);
        EXPECT_LT(largest_difference(y, problem.op().lumped_capacity()), 1e-15);
        EXPECT_EQ(problem.op().capacity_is_diagonal(), kind == "lumped");
      }
  }


  TEST(FiniteElements, material_that_is_not_positive_is_an_error)
  {
    SceneTests::expect_parts(SceneTests::message_of([] {
                               Problem<2>(
                                 {{"Domain/Cells", "8, 8"}, {"Material/Conductivity", "x - 0.3"}},
                                 ModelKind::finite_elements);
                             }),
                             {"'Conductivity'", "positive"});
    SceneTests::expect_parts(
      SceneTests::message_of([] {
        Problem<2>({{"Domain/Cells", "8, 8"}, {"Material/Conductivity", "x - 0.3"}});
      }),
      {"'Conductivity'", "positive"});
    SceneTests::expect_parts(
      SceneTests::message_of([] {
        Problem<2>({{"Domain/Cells", "8, 8"}, {"Material/Density", "x - 0.3"}});
      }),
      {"'Density'", "positive"});
  }
} // namespace PeriDeal
