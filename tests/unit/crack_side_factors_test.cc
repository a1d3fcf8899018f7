// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Factors of bonds and cells beside cracks.

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>

#include <perideal/operators/parts/crack_side_factors.h>

#include <gtest/gtest.h>

#include <numeric>

namespace PeriDeal
{
  using namespace dealii;

  TEST(CrackSideFactors, formula)
  {
    EXPECT_EQ(crack_side_factor(false, 3., 2.), 1.);
    EXPECT_EQ(crack_side_factor(true, 3., 2.), 1.5);
    EXPECT_EQ(crack_side_factor(true, 9., 2.), 4.);
    EXPECT_EQ(crack_side_factor(true, 0.1, 2.), 0.5);
    EXPECT_EQ(crack_side_factor(true, 3., 0.), 1.);
    EXPECT_EQ(crack_side_factor(true, 3., -1.), 1.);
  }


  TEST(CrackSideFactors, cracks_that_conduct)
  {
    // Nothing gets through: as without what crosses.
    EXPECT_EQ(crack_side_factor(true, 3., 2., {0., 1.}), 1.5);
    // Everything does: nothing is missing, even where the sums say so.
    EXPECT_EQ(crack_side_factor(true, 3., 2., {1., 1.}), 1.);
    EXPECT_EQ(crack_side_factor(true, 3., 3., {1., 1.}), 1.);
    // Half of it: g = (3 - 0.5)/(2 - 0.5) counts for a quarter.
    EXPECT_NEAR(crack_side_factor(true, 3., 2., {0.5, 1.}), 1. + 0.25 * (5. / 3. - 1.), 1e-15);
    // Nothing but what crosses: nothing to scale.
    EXPECT_EQ(crack_side_factor(true, 3., 0.5, {0.5, 1.}), 1.);

    const IndexSet         all = complete_index_set(2);
    const Vector           layout(all, MPI_COMM_SELF);
    CrackSideFactors       factors;
    CrackSideFactors::Sums sums(layout);
    factors.start(layout);
    sums.mark({0, 1});
    sums.expected = 3.;
    sums.trace    = 2.;
    sums.add_crossing(0, 1, 4., {0.25, 0.5});
    sums.compress();
    factors.find({0, 1}, sums);
    EXPECT_NEAR(factors.at(0), 1. + 0.25 * (5. / 3. - 1.), 1e-15);
    EXPECT_EQ(factors.at(1), factors.at(0));
    // From the second node nothing crosses: it has lost nothing.
    sums.crossing_whole.local_element(1) = sums.crossing.local_element(1) = 0.;
    sums.leave_out_uncrossed({0, 1});
    factors.find({0, 1}, sums);
    EXPECT_NEAR(factors.at(0), 1. + 0.25 * (5. / 3. - 1.), 1e-15);
    EXPECT_EQ(factors.at(1), 1.);
    sums.clear({0, 1});
    EXPECT_EQ(sums.crossing.linfty_norm() + sums.crossing_whole.linfty_norm(), 0.);
  }


  TEST(CrackSideFactors, means)
  {
    const IndexSet         all = complete_index_set(4);
    const Vector           layout(all, MPI_COMM_SELF);
    CrackSideFactors       factors;
    CrackSideFactors::Sums sums(layout);
    EXPECT_TRUE(factors.empty());
    EXPECT_EQ(factors.of_bond(0, 1), 1.);
    EXPECT_EQ(factors.of_cell({0, 1, 2, 3}), 1.);
    factors.start(layout);
    EXPECT_FALSE(factors.empty());
    EXPECT_EQ(factors.of_cell({0, 1, 2, 3}), 1.);
    sums.mark({1, 2});
    EXPECT_FALSE(sums.any_marked({0, 3}));
    EXPECT_TRUE(sums.any_marked({3, 2}));
    for (unsigned int i = 0; i < 4; ++i)
      {
        sums.expected(i) = 2. + i;
        sums.trace(i)    = 2.;
      }
    factors.find({0, 2}, sums); // 1 keeps what it has
    EXPECT_EQ(factors.at(0), 1.);
    EXPECT_EQ(factors.at(1), 1.);
    EXPECT_EQ(factors.at(2), 2.);
    EXPECT_EQ(factors.of_bond(0, 2), 1.5);
    EXPECT_EQ(factors.of_cell({0, 1, 2, 3}), 1.25);
    sums.clear({0, 1, 2, 3});
    EXPECT_EQ(sums.marked.linfty_norm() + sums.trace.linfty_norm() + sums.expected.linfty_norm(),
              0.);
  }


  TEST(CrackSideFactors, whole_cells_have_what_is_expected)
  {
    // One node between four squares of side h: T = E = V d kappa, with one and with two components.
    Triangulation<2> mesh;
    GridGenerator::subdivided_hyper_cube(mesh, 2, 0., 0.6);
    const FE_Q<2> fe(1);
    DoFHandler<2> dofs(mesh);
    dofs.distribute_dofs(fe);
    const double                         kappa = 3.;
    std::vector<types::global_dof_index> indices(4);
    for (const unsigned int n_components : {1u, 2u})
      {
        FullMatrix<double> stiffness(4 * n_components, 4 * n_components);
        for (unsigned int a = 0; a < 4; ++a)
          for (unsigned int b = 0; b < 4; ++b)
            for (unsigned int c = 0; c < n_components; ++c)
              stiffness(n_components * a + c, n_components * b + c) = kappa * (a == b ? 2. / 3. :
                                                                               (a ^ b) == 3 ?
                                                                                        -1. / 3. :
                                                                                        -1. / 6.);
        const Vector            layout(dofs.locally_owned_dofs(), MPI_COMM_SELF);
        CrackSideFactors::Sums  sums(layout);
        types::global_dof_index middle = 0;
        for (const auto &cell : dofs.active_cell_iterators())
          {
            cell->get_dof_indices(indices);
            for (const unsigned int v : cell->vertex_indices())
              if (cell->vertex(v).distance({0.3, 0.3}) < 1e-9)
                middle = indices[v];
            sums.add(cell, indices, stiffness, 2. * kappa * n_components);
            sums.mark(indices);
          }
        sums.compress();
        EXPECT_NEAR(sums.expected(middle), 0.09 * 2. * kappa * n_components, 1e-14);
        EXPECT_NEAR(sums.trace(middle), sums.expected(middle), 1e-14);
        // Without one of the four the others conduct 4/3 of what they did.
        std::vector<unsigned int> nodes(layout.locally_owned_size());
        std::iota(nodes.begin(), nodes.end(), 0);
        sums.trace(middle) *= 0.75;
        CrackSideFactors factors;
        factors.start(layout);
        factors.find(nodes, sums);
        EXPECT_NEAR(factors.at(middle), 4. / 3., 1e-14);
      }
  }
} // namespace PeriDeal
