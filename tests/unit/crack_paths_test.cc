// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Ways of slow cracks across the mean tension about their tips.

#include <deal.II/base/mpi.h>
#include <deal.II/base/numbers.h>

#include <perideal/base/archive.h>
#include <perideal/operators/solid/crack_paths.h>

#include <gtest/gtest.h>

#include <cmath>

namespace PeriDeal
{
  using dealii::Point;
  using dealii::Tensor;

  namespace
  {
    constexpr double degree = dealii::numbers::PI / 180.;


    Tensor<1, 2> at(const double angle)
    {
      return Tensor<1, 2>({std::cos(angle), std::sin(angle)});
    }


    /** About the end of a crack along x, times a modulus; Poisson ratio 1/3, plane stress. */
    Tensor<1, 2> near_tip(const Tensor<1, 2> &p, const double mode_2)
    {
      const double kappa = 2., half = 0.5 * std::atan2(p[1], p[0]), root = std::sqrt(p.norm());
      const double c = std::cos(half), s = std::sin(half);
      return root *
             Tensor<1, 2>({c * (kappa - 1. + 2. * s * s) + mode_2 * s * (kappa + 1. + 2. * c * c),
                           s * (kappa + 1. - 2. * c * c) - mode_2 * c * (kappa - 1. - 2. * s * s)});
    }


    /** The direction at the end of a crack at an angle to a lattice whose horizon is 4. */
    Tensor<1, 2> direction(const double angle, const Point<2> &tip, const double mode_2)
    {
      constexpr int      m = 4, reach = 2 * m + 2;
      const Tensor<1, 2> way = at(angle), normal = at(angle + 90. * degree);
      CrackPaths<2>      paths({{tip - 100. * way, tip}}, m);
      paths.begin();
      const auto u = [&](const Tensor<1, 2> &x) {
        const Tensor<1, 2> v =
          near_tip(Tensor<1, 2>({(x - tip) * way, (x - tip) * normal}), mode_2);
        return v[0] * way + v[1] * normal;
      };
      for (int i = -reach; i <= reach; ++i)
        for (int j = -reach; j <= reach; ++j)
          for (int k = -m; k <= m; ++k)
            for (int l = -m; l <= m; ++l)
              {
                const Point<2>     a(i, j), b(i + k, j + l);
                const Tensor<1, 2> xi = b - a;
                if (xi.norm() > m || xi.norm() == 0.)
                  continue;
                const double above = (a - tip) * normal, beyond = (b - tip) * normal;
                const double part = above / (above - beyond);
                if (above * beyond < 0. && (a + part * xi - tip) * way < 0.)
                  continue; // cut by the crack
                paths.add(a + 0.5 * xi, xi, (1. - xi.norm() / (m + 0.5)) * (xi * (u(b) - u(a))));
              }
      paths.turn(MPI_COMM_SELF);
      return paths.directions()[1];
    }
  } // namespace


  TEST(CrackPaths, GoAcrossTheLargestHoopStressAtAnyAngleToTheLattice)
  {
    // In the limit the mean of the stress turns by 2 K_II/K_I; measured: at most 1.9 degrees off.
    for (const double angle : {0., 10., 22.5, 33., 45.})
      for (const double mode_2 : {0., 0.05, -0.05})
        for (const Point<2> &tip : {Point<2>(0.1, 0.2), Point<2>(-0.3, 0.45)})
          {
            const Tensor<1, 2> found = direction(angle * degree, tip, mode_2);
            EXPECT_NEAR(std::atan2(found[1], found[0]) / degree, angle - 2. * mode_2 / degree, 3.)
              << angle << " degrees, K_II = " << mode_2;
          }
  }


  TEST(CrackPaths, BondsBreakInTheWayAndFarFromIt)
  {
    // The second crack goes on from the first one: between them there is no tip.
    CrackPaths<2> paths(
      {{Point<2>(0., 0.), Point<2>(1., 0.)}, {Point<2>(1., 0.), Point<2>(2., 1.)}},
      0.1);
    ASSERT_EQ(paths.directions().size(), 2u);
    const auto bond = [](const double x, const double y, const double dx, const double dy) {
      return CrackPaths<2>::Ends(Point<2>(x, y), Point<2>(x + dx, y + dy));
    };
    EXPECT_TRUE(paths.may_break(bond(-0.05, -0.01, 0., 0.05))); // ahead of the first tip
    EXPECT_FALSE(paths.may_break(bond(-0.05, 0.01, 0., 0.05))); // beside its way
    EXPECT_FALSE(paths.may_break(bond(-0.05, 0., 0.05, 0.)));   // along it
    EXPECT_TRUE(paths.may_break(bond(-0.05, 0., 0., 0.05)));    // a node on it is on one side
    EXPECT_FALSE(paths.may_break(bond(-0.05, 0., 0., -0.05)));
    EXPECT_TRUE(paths.may_break(bond(1., 0.5, 0., 0.05)));     // no tip there
    EXPECT_FALSE(paths.may_break(bond(2.05, 1., 0.03, 0.03))); // along the second way
    EXPECT_TRUE(paths.may_break(bond(2.05, 1., -0.03, 0.06)));

    // It goes on to where bonds break, and the tip looks across the tension there.
    paths.advance({bond(-0.15, -0.02, 0., 0.05), bond(-0.05, -0.02, 0., 0.05)}, MPI_COMM_SELF);
    paths.begin();
    const Tensor<1, 2> across = at(-20. * degree);
    paths.add(Point<2>(-0.15, 0.), at(70. * degree), 2.);
    paths.add(Point<2>(-0.15, 0.), across, 1.);
    paths.turn(MPI_COMM_SELF);
    EXPECT_NEAR(paths.directions()[0] * across, -1., 1e-12);
    EXPECT_TRUE(paths.may_break(bond(-0.05, -0.02, 0., 0.05))); // behind
    EXPECT_TRUE(paths.may_break(bond(-0.2, 0.005, 0., 0.05)));  // ahead
    EXPECT_FALSE(paths.may_break(bond(-0.2, -0.04, 0., 0.05)));

    // What is kept of them.
    MemoryArchive saved(MPI_COMM_SELF);
    paths.exchange(saved);
    CrackPaths<2> again(
      {{Point<2>(0., 0.), Point<2>(1., 0.)}, {Point<2>(1., 0.), Point<2>(2., 1.)}},
      0.1);
    EXPECT_FALSE(again.may_break(bond(-0.2, 0.005, 0., 0.05)));
    MemoryArchive loaded(saved, MPI_COMM_SELF);
    again.exchange(loaded);
    EXPECT_TRUE(again.may_break(bond(-0.2, 0.005, 0., 0.05)));
    EXPECT_TRUE(again.may_break(bond(-0.05, -0.02, 0., 0.05)));
    EXPECT_NEAR(again.directions()[0] * across, -1., 1e-12);
  }
} // namespace PeriDeal
