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
    /** Value of a vector at the unknown nearest to a point, on every process. */
    template <int dim>
    double value_at(const Problem<dim> &problem, const Vector &u, const Point<dim> &p)
    {
      double sum = 0.;
      for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
        if (problem.positions[i].distance(p) < 1e-9)
          sum += u.local_element(i);
      return sum_of_all(sum);
    }
  } // namespace


  TEST(NodeConstraints, the_side_named_first_holds_at_corners)
  {
    for (const ModelKind model : {ModelKind::peridynamics, ModelKind::finite_elements})
      {
        const Settings   plate{{"Domain/Cells", "6, 6"}};
        const Problem<2> first(
          plate + Settings{{"Boundary conditions/Dirichlet", "top: 1 ; left: 2 + t ; bottom: 3"}},
          model);
        Vector u = first.vector();
        first.op().distribute(u, 0.5);
        EXPECT_EQ(value_at<2>(first, u, {0., 1.}), 1.);
        EXPECT_EQ(value_at<2>(first, u, {0., 0.5}), 2.5);
        EXPECT_EQ(value_at<2>(first, u, {0., 0.}), 2.5);
        EXPECT_EQ(value_at<2>(first, u, {0.5, 0.}), 3.);
        EXPECT_EQ(value_at<2>(first, u, {0.5, 0.5}), 0.);
        EXPECT_TRUE(first.op().depends_on_time());
        first.op().distribute_homogeneous(u);
        EXPECT_EQ(u.linfty_norm(), 0.);
      }
  }


  TEST(NodeConstraints, layer_rows_carry_the_value_at_their_own_place)
  {
    for (const std::string placement : {"vertices", "cell centers"})
      {
        const Problem<2> problem({{"Domain/Cells", "10, 10"},
                                  {"Domain/Nodes", placement},
                                  {"Peridynamics/Boundary treatment", "layer"},
                                  {"Peridynamics/Layer rows", "2"},
                                  {"Boundary conditions/Dirichlet", "left: 1 + x ; top: 5 + y"}});
        Vector           u = problem.vector();
        problem.op().distribute(u, 0.);
        for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
          {
            const Point<2> p    = problem.positions[i];
            const bool     left = p[0]<0.17, top = p[1]> 0.83;
            EXPECT_DOUBLE_EQ(u.local_element(i), left ? 1. + p[0] : top ? 5. + p[1] : 0.) << p;
          }
      }
  }


  TEST(NodeConstraints, extrapolation_of_a_linear_field_is_exact)
  {
    // kappa T' = -q at the end where q enters... into the body is positive: T' = q/kappa on the
    // right, -q/kappa on the left.
    for (const std::string treatment : {"extrapolation", "layer extrapolation"})
      for (const std::string kernel : {"constant", "conical", "gaussian"})
        {
          const Problem<1> problem({{"Domain/Cells", "40"},
                                    {"Material/Conductivity", "2"},
                                    {"Peridynamics/Kernel", kernel},
                                    {"Peridynamics/Flux treatment", treatment},
                                    {"Boundary conditions/Flux", "left: -3 ; right: 3"}});
          EXPECT_FALSE(problem.op().symmetric());
          const auto   f = [](const Point<1> &p) { return 7. + 1.5 * p[0]; };
          Vector       u = problem.values(f), r = problem.vector();
          const Vector exact(u);
          for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
            if (problem.positions[i][0] < 1e-9 || problem.positions[i][0] > 1. - 1e-9)
              u.local_element(i) = -100.;
          problem.op().distribute(u, 0.);
          EXPECT_LT(largest_difference(u, exact), 1e-12) << treatment << ", " << kernel;
        }
    // On a side of a plate, away from its corners.
    const Problem<2> plate({{"Domain/Cells", "20, 20"},
                            {"Peridynamics/Flux treatment", "extrapolation"},
                            {"Boundary conditions/Dirichlet", "left: 1"},
                            {"Boundary conditions/Flux", "right: 2"}});
    Vector           u = plate.values([](const auto &p) { return 1. + 2. * p[0]; });
    plate.op().distribute(u, 0.);
    EXPECT_NEAR(value_at<2>(plate, u, {1., 0.5}), 3., 1e-12);
  }


  TEST(NodeConstraints, coupled_slaves_meet_their_equations)
  {
    // T_b sum w L = sum w L T + q over the whole family, slaves included; a corner follows the side
    // named first.
    const std::vector<std::string> orders = {"right: 2 ; bottom: x ; top: y",
                                             "top: y ; bottom: x; right: 2"};
    for (const std::string &order : orders)
      {
        const Problem<2> problem({{"Domain/Cells", "12, 12"},
                                  {"Peridynamics/Flux treatment", "extrapolation"},
                                  {"Boundary conditions/Dirichlet", "left: 1"},
                                  {"Boundary conditions/Flux", order}});
        Vector           u = problem.values(bumpy<2>);
        problem.op().distribute(u, 0.);
        u.update_ghost_values();
        const auto &families = bonds_of(problem.op()).diffusion_bonds();
        std::vector<typename DiffusionBonds<2>::Bond> bonds;
        unsigned int                                  n = 0;
        for (unsigned int i = 0; i < problem.nodes->n_owned(); ++i)
          {
            const Point<2> p     = problem.positions[i];
            const bool     right = p[0] > 1. - 1e-9, bottom = p[1]<1e-9, top = p[1]> 1. - 1e-9;
            if (p[0] < 1e-9 || !(right || bottom || top))
              continue;
            const bool   of_right = right && (order == orders[0] || !(top || bottom));
            const double q        = of_right ? 2. : bottom ? p[0] : p[1];
            double       sum = 0., flux = 0.;
            families.bonds_of(i, bonds, false);
            for (const auto &bond : bonds)
              {
                const auto   xi = families.neighbors().bond_vector(i, bond.neighbor);
                const double L  = of_right ? -xi[0] : bottom ? xi[1] : -xi[1];
                if (L < 1e-9)
                  continue;
                const double w = bond.weight / problem.nodes->volume(i) * L;
                sum += w;
                flux += w * (u.local_element(i) - u.local_element(bond.neighbor));
              }
            ++n;
            EXPECT_NEAR(flux, q, 1e-11 * sum) << p;
          }
        EXPECT_EQ(sum_of_all(n), 35u);
      }
  }


  TEST(NodeConstraints, isolated_nodes_are_an_error)
  {
    // A box of cracks around one node.
    SceneTests::expect_error(
      [] {
        Problem<2>({{"Domain/Cells", "10, 10"},
                    {"Cracks/Segments",
                     "0.45,0.45 ; 0.55,0.45 ; 0.55,0.45 ; 0.55,0.55 ; 0.55,0.55 ; 0.45,0.55 ; "
                     "0.45,0.55 ; 0.45,0.45"}});
      },
      {"(0.5, 0.5)", "isolated", "'Cracks'"});
  }
} // namespace PeriDeal
