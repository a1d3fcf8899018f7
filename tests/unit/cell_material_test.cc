// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Integrals of conductivity and capacity over cells, by hand.

#include <perideal/base/user_error.h>
#include <perideal/operators/diffusion/cell_material.h>

#include "operator_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using dealii::Point;

  namespace
  {
    /** The unit square of 4 x 4 cells. */
    struct Square
    {
      explicit Square(const Settings &material, const bool steady = false)
        : problem(Settings{{"Domain/Cells", "4, 4"}} + material, ModelKind::finite_elements)
        , cells(problem.handler,
                problem.scene.material,
                problem.scene.initial_and_source.initial_value,
                steady)
        , stiffness(4, 4)
        , mass(4, 4)
      {}

      /** Sums over all cells of u^T K u and of the entries of C. */
      std::pair<double, double> sums(const Vector &u)
      {
        std::vector<dealii::types::global_dof_index> indices(4);
        double                                       energy = 0., capacity = 0.;
        u.update_ghost_values();
        for (const auto &cell : problem.handler.active_cell_iterators())
          if (cell->is_locally_owned())
            {
              cells.assemble(cell, stiffness, mass);
              cell->get_dof_indices(indices);
              for (unsigned int a = 0; a < 4; ++a)
                for (unsigned int b = 0; b < 4; ++b)
                  {
                    energy += u(indices[a]) * stiffness(a, b) * u(indices[b]);
                    capacity += mass(a, b);
                  }
            }
        u.set_ghost_state(false);
        return {sum_of_all(energy), sum_of_all(capacity)};
      }

      Problem<2>                 problem;
      CellMaterial<2>            cells;
      dealii::FullMatrix<double> stiffness, mass;
    };

    double x_of(const Point<2> &p)
    {
      return p[0];
    }
  } // namespace


  TEST(CellMaterial, matrices)
  {
    Square body(Settings{{"Material/Conductivity", "1 + y"},
                         {"Material/Density", "2"},
                         {"Material/Heat capacity", "1 + x"}});
    const auto [energy, capacity] = body.sums(body.problem.values(x_of));
    EXPECT_NEAR(energy, 1.5, 1e-13);
    EXPECT_NEAR(capacity, 3., 1e-13);
    for (const auto &cell : body.problem.handler.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          EXPECT_NEAR(body.cells.center_conductivity(cell), 1. + cell->center()[1], 1e-14);
        }
    Square steady(Settings{{"Material/Density", "2"}}, true);
    EXPECT_NEAR(steady.sums(steady.problem.values(x_of)).second, 1., 1e-13);
  }


  TEST(CellMaterial, of_the_temperatures_taken)
  {
    Square       body(Settings{{"Initial and source/Initial value", "3"},
                         {"Material/Conductivity", "1 + T"},
                         {"Material/Density", "1"},
                         {"Material/Heat capacity", "2 + T"}});
    const Vector x = body.problem.values(x_of);
    EXPECT_NEAR(body.sums(x).first, 4., 1e-13);
    EXPECT_NEAR(body.sums(x).second, 5., 1e-13);
    const Vector u = body.problem.values([](const Point<2> &p) { return 2. * p[1]; });
    body.cells.take(u);
    EXPECT_NEAR(body.sums(x).first, 2., 1e-13);
    EXPECT_NEAR(body.sums(x).second, 3., 1e-13);
    for (const auto &cell : body.problem.handler.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          EXPECT_NEAR(body.cells.center_conductivity(cell), 1. + 2. * cell->center()[1], 1e-13);
        }
  }


  TEST(CellMaterial, heat)
  {
    // Of T + T^2/2 each, whatever the material was last taken at.
    Square       body(Settings{{"Material/Density", "1"}, {"Material/Heat capacity", "1 + T"}});
    const Vector u = body.problem.values(x_of),
                 v = body.problem.values([](const Point<2> &p) { return 2. + p[0]; });
    Vector y       = body.problem.vector();
    body.cells.take(v);
    const auto content = [&](const Vector &w) { return sum_of_all(body.cells.content(w)); };
    EXPECT_NEAR(content(u), 0.5 + 1. / 6., 1e-13);
    EXPECT_NEAR(content(v), 2.5 + (27. - 8.) / 6., 1e-13);
    for (const bool lumped : {true, false})
      {
        body.cells.heat_between(y, u, v, lumped);
        EXPECT_NEAR(y.mean_value() * y.size(), content(v) - content(u), 1e-13) << lumped;
      }
  }


  TEST(CellMaterial, refuses_what_is_not_positive)
  {
    EXPECT_THROW(Square(Settings{{"Material/Conductivity", "x - 0.7"}}), UserError);
    EXPECT_THROW(Square(Settings{{"Material/Heat capacity", "x - 0.7"}}), UserError);
  }
} // namespace PeriDeal
