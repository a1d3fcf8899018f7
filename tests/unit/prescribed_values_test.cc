// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Which unknowns of finite elements are held, and by what.

#include <perideal/base/user_error.h>
#include <perideal/operators/diffusion/prescribed_values.h>

#include "operator_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using dealii::Point;

  namespace
  {
    /** A square of 4 x 4 cells with the nodes that its conditions hold. */
    struct HeldSquare
    {
      explicit HeldSquare(const Settings &conditions)
        : problem(Settings{{"Domain/Cells", "4, 4"}} + conditions, ModelKind::finite_elements)
        , layout(problem.vector())
        , hanging(problem.handler, *layout.get_partitioner())
        , held(problem.handler,
               *layout.get_partitioner(),
               problem.scene.boundary_conditions,
               hanging,
               unknowns_of_parts(problem.handler,
                                 problem.scene.boundary_conditions,
                                 [&](const auto dof) { return hanging.is_hanging(dof); }))
      {}

      Problem<2>          problem;
      Vector              layout;
      HangingNodes<2>     hanging;
      PrescribedValues<2> held;
    };


    /** What is expected of u at each place; negative: not held. */
    template <typename Expected>
    void expect_values(const HeldSquare &body, const double t, const Expected &expected)
    {
      Vector u = body.problem.vector(), marked = u;
      u = -1.;
      body.held.distribute(u, t);
      body.held.mask(marked, 1.);
      std::size_t n = 0;
      for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
        {
          const Point<2> &p = body.problem.positions[i];
          EXPECT_NEAR(u.local_element(i), expected(p), 1e-14) << p;
          EXPECT_EQ(marked.local_element(i), expected(p) < 0. ? 0. : 1.) << p;
          n += expected(p) < 0. ? 0 : 1;
        }
      EXPECT_EQ(body.held.held().size(), n);
      EXPECT_TRUE(std::is_sorted(body.held.held().begin(), body.held.held().end()));
    }
  } // namespace


  TEST(PrescribedValues, the_condition_named_first_holds)
  {
    const HeldSquare body(
      Settings{{"Boundary conditions/Dirichlet", "left: 1 + y ; bottom: 5 + t*x"}});
    EXPECT_TRUE(body.held.any());
    for (const double t : {0., 2.})
      expect_values(body, t, [&](const Point<2> &p) {
        return p[0] < 1e-9 ? 1. + p[1] : p[1] < 1e-9 ? 5. + t * p[0] : -1.;
      });
    const HeldSquare other(Settings{{"Boundary conditions/Dirichlet", "bottom: 5 ; left: 1"}});
    expect_values(other, 0., [](const Point<2> &p) {
      return p[1] < 1e-9 ? 5. : p[0] < 1e-9 ? 1. : -1.;
    });
  }


  TEST(PrescribedValues, parts_regions_and_points)
  {
    const HeldSquare body(Settings{
      {"Boundary conditions/Parts",
       "low: left if y < 0.3 ; core: region (x - 0.5)^2 + (y - 0.5)^2 < 0.01 ; tip: point 1, 1"},
      {"Boundary conditions/Dirichlet", "low: 1 ; core: 2 ; tip: 3 + t"}});
    expect_values(body, 4., [](const Point<2> &p) {
      return p[0] < 1e-9 && p[1] < 0.3    ? 1. :
             p.distance({0.5, 0.5}) < 0.1 ? 2. :
             p.distance({1., 1.}) < 1e-9  ? 7. :
                                            -1.;
    });
    EXPECT_THROW(HeldSquare(Settings{{"Boundary conditions/Parts", "low: left if y < 0.3"},
                                     {"Boundary conditions/Dirichlet", "left: 1 ; low: 2"}}),
                 UserError);
  }


  TEST(PrescribedValues, sums_of_rows)
  {
    const HeldSquare body(Settings{{"Boundary conditions/Dirichlet", "left: 1 ; top: 2"}});
    const Vector y = body.problem.values([](const Point<2> &p) { return 1. + p[0] + 3. * p[1]; });
    const unsigned int            n = y.locally_owned_size();
    std::map<std::string, double> sides;
    body.held.add_to(sides, y);
    double expected[2] = {0., 0.};
    for (unsigned int i = 0; i < n; ++i)
      if (const Point<2> &p = body.problem.positions[i]; p[0] < 1e-9)
        expected[0] += y.local_element(i);
      else if (p[1] > 1. - 1e-9)
        expected[1] += y.local_element(i);
    EXPECT_NEAR(sides["left"], expected[0], 1e-12);
    EXPECT_NEAR(sides["top"], expected[1], 1e-12);
    EXPECT_NEAR(body.held.sum(y, 0, n), expected[0] + expected[1], 1e-12);
    EXPECT_NEAR(body.held.sum(y, 0, n / 2) + body.held.sum(y, n / 2, n),
                expected[0] + expected[1],
                1e-12);
    // Rows beyond those asked for are left alone.
    Vector z = y;
    body.held.mask(z, -7., n / 3, n / 2);
    for (unsigned int i = 0; i < n; ++i)
      {
        const bool held = body.problem.positions[i][0] < 1e-9 ||
                          body.problem.positions[i][1] > 1. - 1e-9;
        EXPECT_EQ(z.local_element(i), held && i >= n / 3 && i < n / 2 ? -7. : y.local_element(i));
      }
  }


  TEST(PrescribedValues, nothing_held)
  {
    const HeldSquare body(Settings{{"Boundary conditions/Flux", "left: 1"}});
    EXPECT_FALSE(body.held.any());
    EXPECT_TRUE(body.held.held().empty());
  }
} // namespace PeriDeal
