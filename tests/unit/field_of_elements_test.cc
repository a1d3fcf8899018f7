// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors


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
      const Vector       u     = problem.steady(1e-14);
      const Vector       exact = problem.values([](const Point<dim> &p) {
        return 1. + 2. * p[0] - (dim > 1 ? p[dim > 1] : 0.) + (dim > 2 ? 3. * p[dim - 1] : 0.);
      });
      EXPECT_LT(largest_difference(u, exact), 1e-12) << dim;
    }


    template <int dim>
    void conserves(const Settings &settings, const std::string &what)
    {
      expect_conservation(Problem<dim>(settings, ModelKind::finite_elements), what);
    }


    /** The steady flow through a body from its bottom, at 0, to its top, at 1. */
    double flow_upwards(const Settings &more)
    {
      const Problem<2> problem(Settings{{"Boundary conditions/Dirichlet", "bottom: 0 ; top: 1"}} +
                                 more,
                               ModelKind::finite_elements);
      return problem.op().balance(problem.steady(1e-13), 0., true).sides.at("top");
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
        const Vector above = problem.values([](const auto &p) { return p[1] > 0.49 ? 1. : 0.; });
        EXPECT_LT(problem.product(above).linfty_norm(), 1e-14) << height;
        conserves<2>(settings, height);
        unsigned int n_cut = 0;
        for (const auto &cell : problem.handler.active_cell_iterators())
          if (cell->is_locally_owned() &&
              cells_of(problem.op()).cut_cells()[cell->active_cell_index()])
            ++n_cut;
        EXPECT_EQ(sum_of_all(n_cut), 8u);
      }
    conserves<3>({{"Domain/Cells", "4, 4, 4"},
                  {"Cracks/Polygons", "0.1,0.1,0.4 ; 0.8,0.1,0.4 ; 0.8,0.8,0.6 ; 0.1,0.8,0.6"},
                  {"Peridynamics/Surface correction", "crack scaling"}},
                 "3D");
    conserves<2>({{"Domain/Cells", "8, 8"}, {"Cracks/Segments", "0.2,0.3 ; 0.7,0.6"}}, "oblique");
  }


  TEST(FiniteElements, pairs_with_contact_conductance)
  {
    // Steady heat through a body cut in half by a contact: resistances in series, R = 1/kappa (1 -
    // h) + (h/kappa + 1/H) of the row of cut cells.
    for (const std::string given : {"Contact conductance", "Transmission"})
      {
        const double H = 3.;
        const double flux =
          flow_upwards({{"Domain/Cells", "9, 9"},
                        {"Material/Conductivity", "2"},
                        {"Cracks/Segments", "-1,0.48 ; 2,0.48"},
                        {"Cracks/" + given, given == "Transmission" ? "0.4" : "3"}});
        EXPECT_LT(flux, 2.);
        EXPECT_GT(flux, 0.2);
        // Pairs of Q1 squares: edges kappa/6 each side, diagonals kappa/3, all scaled by H h/(H h +
        // kappa).
        if (given == "Contact conductance")
          {
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
        const double flux = flow_upwards({{"Domain/Cells", "9, 9"},
                                          {"Material/Conductivity", "2"},
                                          {"Cracks/Segments", "-1,0.48 ; 2,0.48"},
                                          {"Cracks/Contact conductance", std::to_string(H)},
                                          {"Peridynamics/Surface correction", "crack scaling"}});
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
    Vector above = halves.vector();
    for (unsigned int i = 0; i < above.locally_owned_size(); ++i)
      above.local_element(i) = halves.sides[i][1] > 0.5 ? 1. : 0.;
    EXPECT_NEAR(above.l1_norm(), 45., 1e-12);
    EXPECT_LT(halves.product(above).linfty_norm(), 1e-14);

    conserves<3>({{"Domain/Cells", "4, 4, 4"},
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
    const Vector     above = problem.values([](const auto &p) { return p[1] > 0.47 ? 1. : 0.; });
    EXPECT_LT(problem.product(above).linfty_norm(), 1e-14);
    // Two cracks, one in each of two neighbouring rows of cells: the nodes between have no cell
    // left.
    SceneTests::expect_error(
      [] {
        Problem<2>({{"Domain/Cells", "8, 8"},
                    {"Cracks/Mesh", "removed"},
                    {"Cracks/Segments", "-1,0.47 ; 2,0.47 ; -1,0.55 ; 2,0.55"}},
                   ModelKind::finite_elements);
      },
      {"'Mesh'", "'Cracks'", "without any conducting cell"});
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
    for (const auto &[entry, model] : {std::pair("Conductivity", ModelKind::finite_elements),
                                       std::pair("Conductivity", ModelKind::peridynamics),
                                       std::pair("Density", ModelKind::peridynamics)})
      {
        const Settings wrong{{"Domain/Cells", "8, 8"},
                             {std::string("Material/") + entry, "x - 0.3"}};
        SceneTests::expect_error([&, kind = model] { Problem<2>(wrong, kind); },
                                 {std::string("'") + entry + "'", "positive"});
      }
  }
} // namespace PeriDeal
