// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Matrices of cells that a crack cuts, against those of the whole body and its pairs.

#include "operator_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using dealii::Point;

  namespace
  {
    /** y = K u, cell by cell. */
    Vector product(const CellMatrices<2> &cells, const Problem<2> &problem, const Vector &u)
    {
      Vector y = problem.vector();
      u.update_ghost_values();
      for (const auto &cell : problem.handler.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            const auto &own = cells.assemble(cell);
            for (unsigned int a = 0; a < own.indices.size(); ++a)
              for (unsigned int b = 0; b < own.indices.size(); ++b)
                y(own.indices[a]) += own.stiffness(a, b) * u(own.indices[b]);
          }
      u.set_ghost_state(false);
      y.compress(dealii::VectorOperation::add);
      return y;
    }
  } // namespace


  TEST(CellMatrices, cut_and_scaled)
  {
    const Settings   crack{{"Domain/Cells", "9, 8"},
                         {"Cracks/Segments", "0.2,0.44 ; 0.7,0.57"},
                         {"Cracks/Transmission", "0.3"},
                         {"Peridynamics/Surface correction", "crack scaling"}};
    const Problem<2> problem(crack, ModelKind::finite_elements);
    const Scene<2>  &scene = problem.scene;
    CellMaterial<2>  material(problem.handler,
                             scene.material,
                             scene.initial_and_source.initial_value,
                             false);
    CrackSideFactors factors;
    CellMatrices<2>  cells(
      problem.handler,
      material,
      nullptr,
      factors,
      {false, false, scene.cracks.contact_conductance, [&scene] { return scene.horizon(); }});
    // Without cracks the cells are whole.
    dealii::FullMatrix<double> whole(4, 4), mass(4, 4), difference(4, 4);
    for (const auto &cell : problem.handler.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          material.assemble(cell, whole, mass);
          difference = cells.assemble(cell).stiffness;
          difference.add(-1., whole);
          EXPECT_EQ(difference.linfty_norm(), 0.);
        }
    EXPECT_TRUE(std::isinf(cells.lowest_remainder()));

    const auto history = scene.crack_history();
    cells.cut().set(history.pieces(0.), history.transmission(0.));
    EXPECT_EQ(cells.cut().flags(), cells_of(problem.op()).cut_cells());
    cells.find_factors(problem.vector());
    EXPECT_FALSE(factors.empty());
    unsigned int n_cut = 0;
    for (const auto &cell : problem.handler.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          material.assemble(cell, whole, mass);
          difference = cells.assemble_intact(cell, true).stiffness;
          difference.add(-1., whole);
          EXPECT_EQ(difference.linfty_norm(), 0.);
          const auto &own = cells.assemble(cell);
          for (unsigned int a = 0; a < 4; ++a)
            {
              double row = 0.;
              for (unsigned int b = 0; b < 4; ++b)
                row += own.stiffness(a, b);
              EXPECT_NEAR(row, 0., 1e-14); // nothing is lost
            }
          n_cut += cells.cut().is_cut(cell) ? 1 : 0;
        }
    EXPECT_GT(sum_of_all(n_cut), 3.);
    const Vector u = problem.values(bumpy<2>);
    Vector       y = problem.vector();
    problem.op().multiply(y, u);
    EXPECT_LT(relative_difference(product(cells, problem, u), y), 1e-13);

    // In the field y heat flows down through the crack: by the pairs that it separates.
    const auto height   = [](const Point<2> &p) { return p[1]; };
    const auto above    = [](const Point<2> &p) { return p[1] > 0.44 + 0.26 * (p[0] - 0.2); };
    double     expected = 0.;
    for (const auto &cell : problem.handler.active_cell_iterators())
      if (cell->is_locally_owned() && cells.cut().is_cut(cell))
        {
          const auto &own = cells.assemble(cell);
          for (const unsigned int a : cell->vertex_indices())
            for (const unsigned int b : cell->vertex_indices())
              {
                std::vector<std::pair<unsigned int, int>> crossed;
                cells.cut().kept_fraction(
                  cell,
                  a,
                  b,
                  [](const unsigned int, const unsigned int) { return 1.; },
                  &crossed);
                if (!crossed.empty() && above(cell->vertex(a)) && !above(cell->vertex(b)))
                  expected -= own.stiffness(a, b) * (cell->vertex(a)[1] - cell->vertex(b)[1]);
              }
        }
    Balance balance;
    balance.cracks.assign(1, 0.);
    cells.add_heat(problem.values(height), balance);
    EXPECT_GT(sum_of_all(expected), 0.05);
    EXPECT_NEAR(std::abs(sum_of_all(balance.cracks[0])), sum_of_all(expected), 1e-13);
    EXPECT_NEAR(sum_of_all(balance.cracks[0]),
                problem.op().balance(problem.values(height), 0., true).cracks[0],
                1e-13);
  }
} // namespace PeriDeal
