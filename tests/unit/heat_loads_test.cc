// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Loads of finite elements against integrals by hand.

#include <perideal/operators/diffusion/heat_loads.h>

#include "operator_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using dealii::Point;

  namespace
  {
    /** The unit square of 6 x 5 cells and what enters it. */
    struct LoadedSquare
    {
      explicit LoadedSquare(const Settings &conditions)
        : problem(Settings{{"Domain/Cells", "6, 5"}} + conditions, ModelKind::finite_elements)
        , hanging(problem.handler, *problem.vector().get_partitioner())
        , loads(problem.handler,
                problem.vector().get_partitioner(),
                problem.scene.boundary_conditions,
                problem.scene.initial_and_source.source,
                hanging)
      {}

      /** sum of f_i w(x_i): the integral of all loads times w, where w is linear. */
      template <typename Weight>
      double moment(const double t, const Weight &w) const
      {
        return loads.at(t) * problem.values(w);
      }

      Problem<2>      problem;
      HangingNodes<2> hanging;
      HeatLoads<2>    loads;
    };

    double one(const Point<2> &)
    {
      return 1.;
    }

    double x_of(const Point<2> &p)
    {
      return p[0];
    }
  } // namespace


  TEST(HeatLoads, integrals)
  {
    const LoadedSquare source(Settings{{"Initial and source/Source", "2*x"}});
    EXPECT_FALSE(source.loads.depends_on_time());
    EXPECT_NEAR(source.moment(0., one), 1., 1e-13);
    EXPECT_NEAR(source.moment(0., x_of), 2. / 3., 1e-13);
    EXPECT_NEAR(sum_of_all(source.loads.sum()), 1., 1e-13);
    const LoadedSquare sides(Settings{{"Boundary conditions/Flux", "top: 3*x"},
                                      {"Boundary conditions/Convection", "right: 2, 4 + y*t"}});
    EXPECT_TRUE(sides.loads.depends_on_time());
    for (const double t : {0., 3.})
      {
        const double ambient = 2. * (4. + 0.5 * t);
        EXPECT_NEAR(sides.moment(t, one), 1.5 + ambient, 1e-13) << t;
        EXPECT_NEAR(sides.moment(t, x_of), 1. + ambient, 1e-13) << t;
        EXPECT_NEAR(sum_of_all(sides.loads.sum()), 1.5 + ambient, 1e-13) << t;
      }
    // Fluxes in regions and at points are totals; a part of a side counts its area.
    const LoadedSquare parts(Settings{
      {"Boundary conditions/Parts", "core: region x > 0.4 ; tip: point 0, 0 ; lid: top if x < 0.3"},
      {"Boundary conditions/Flux", "core: 5 ; tip: 7 ; lid: 10"}});
    EXPECT_NEAR(parts.moment(0., one), 5. + 7. + 3., 1e-12);
  }


  TEST(HeatLoads, convection)
  {
    const LoadedSquare body(
      Settings{{"Boundary conditions/Convection", "right: 2, 4 + y ; top: 3, 1"}});
    const Vector u = body.problem.values([](const Point<2> &p) { return 1. + p[0] + p[1]; });
    // Of h u: on the right 2 (2 + y), at the top 3 (2 + x).
    EXPECT_NEAR(sum_of_all(body.loads.through_transfer(u)), -5. - 7.5, 1e-12);
    double                                       total = 0.;
    dealii::FullMatrix<double>                   matrix(4, 4);
    std::vector<dealii::types::global_dof_index> indices(4);
    u.update_ghost_values();
    for (const auto &cell : body.problem.handler.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          body.loads.find_transfer(cell, matrix);
          cell->get_dof_indices(indices);
          for (unsigned int a = 0; a < 4; ++a)
            for (unsigned int b = 0; b < 4; ++b)
              total += matrix(a, b) * u(indices[b]);
        }
    EXPECT_NEAR(sum_of_all(total), 5. + 7.5, 1e-12);
  }


  TEST(HeatLoads, balance)
  {
    const LoadedSquare body(Settings{{"Initial and source/Source", "2*x + t"},
                                     {"Boundary conditions/Parts", "core: region x > 0.4"},
                                     {"Boundary conditions/Flux", "top: 3*x ; core: 5*t"},
                                     {"Boundary conditions/Convection", "right: 2, 4 + y"}});
    const Vector       u = body.problem.values([](const Point<2> &p) { return 1. + p[0] + p[1]; });
    Balance            balance;
    body.loads.add_to(balance, u, 2.);
    EXPECT_NEAR(sum_of_all(balance.sources), 1. + 2., 1e-12);
    EXPECT_NEAR(sum_of_all(balance.sides["top"]), 1.5, 1e-12);
    EXPECT_NEAR(sum_of_all(balance.sides["core"]), 10., 1e-12);
    EXPECT_NEAR(sum_of_all(balance.sides["right"]), 2. * (4.5 - 2.5), 1e-12);
    // All that enters: f minus what convection takes away.
    double all = balance.sources;
    for (const auto &[name, value] : balance.sides)
      all += value;
    body.loads.at(2.);
    EXPECT_NEAR(sum_of_all(body.loads.sum() + body.loads.through_transfer(u)),
                sum_of_all(all),
                1e-12);
  }
} // namespace PeriDeal
