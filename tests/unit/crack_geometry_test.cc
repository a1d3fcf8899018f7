// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/crack_geometry.h>

#include <gtest/gtest.h>

#include <random>

namespace PeriDeal
{
  using dealii::Point;


  TEST(CrackGeometry, left_side_is_start_to_end_turned_left)
  {
    const CrackGeometry<2> crack({Point<2>(0., 0.), Point<2>(2., 0.)});
    EXPECT_DOUBLE_EQ(crack.normal()[1], 1.);
    EXPECT_DOUBLE_EQ(crack.measure(), 2.);
    EXPECT_GT(crack.signed_distance(Point<2>(1., 0.5)), 0.);
    EXPECT_LT(crack.signed_distance(Point<2>(1., -0.5)), 0.);
    // On the crack: left, so cut from the right side and not from the left one.
    EXPECT_GT(crack.signed_distance(Point<2>(1., 0.)), 0.);
    EXPECT_TRUE(crack.separates(Point<2>(1., 0.), Point<2>(1., -0.1)));
    EXPECT_FALSE(crack.separates(Point<2>(1., 0.), Point<2>(1., 0.1)));

    const CrackGeometry<2> turned({Point<2>(2., 0.), Point<2>(0., 0.)});
    EXPECT_FALSE(turned.separates(Point<2>(1., 0.), Point<2>(1., -0.1)));
    EXPECT_TRUE(turned.separates(Point<2>(1., 0.), Point<2>(1., 0.1)));
  }


  TEST(CrackGeometry, tips_and_collinear_bonds)
  {
    const CrackGeometry<2> crack({Point<2>(0., 0.), Point<2>(2., 0.)});
    // Both on the crack, one on it and one beyond its tip, both beyond: none is separated.
    EXPECT_FALSE(crack.separates(Point<2>(0.5, 0.), Point<2>(1.5, 0.)));
    EXPECT_FALSE(crack.separates(Point<2>(1.5, 0.), Point<2>(2.5, 0.)));
    EXPECT_FALSE(crack.separates(Point<2>(-1., 0.), Point<2>(3., 0.)));
    // Through the tip: not cut, whichever way the bond leans; just before it, cut.
    for (const double dx : {-0.5, 0., 0.5})
      {
        EXPECT_FALSE(crack.separates(Point<2>(2. + dx, 0.5), Point<2>(2. - dx, -0.5)));
        EXPECT_FALSE(crack.separates(Point<2>(dx, 0.5), Point<2>(-dx, -0.5)));
        EXPECT_TRUE(crack.separates(Point<2>(2. - 1e-6 + dx, 0.5), Point<2>(2. - 1e-6 - dx, -0.5)));
        EXPECT_TRUE(crack.separates(Point<2>(1e-6 + dx, 0.5), Point<2>(1e-6 - dx, -0.5)));
      }
    EXPECT_FALSE(crack.separates(Point<2>(2. + 1e-6, 0.5), Point<2>(2. + 1e-6, -0.5)));
    // An end on the surface of the body, or on another crack, is no tip.
    CrackGeometry<2> edge_crack(crack);
    edge_crack.close(1);
    EXPECT_TRUE(edge_crack.separates(Point<2>(2., 0.5), Point<2>(2., -0.5)));
    EXPECT_TRUE(edge_crack.separates(Point<2>(2.5, 0.5), Point<2>(1.5, -0.5)));
    EXPECT_FALSE(edge_crack.separates(Point<2>(0., 0.5), Point<2>(0., -0.5)));
    CrackGeometry<2> branch(crack);
    branch.close_joints(CrackGeometry<2>({Point<2>(0., -1.), Point<2>(0., 1.)}));
    EXPECT_TRUE(branch.separates(Point<2>(0., 0.5), Point<2>(0., -0.5)));
    EXPECT_FALSE(branch.separates(Point<2>(2., 0.5), Point<2>(2., -0.5)));
    EXPECT_TRUE(crack.contains(Point<2>(0., 0.)));
    EXPECT_TRUE(crack.contains(Point<2>(1., 0.)));
    EXPECT_FALSE(crack.contains(Point<2>(2.1, 0.)));
    EXPECT_FALSE(crack.contains(Point<2>(1., 1e-6)));
  }


  TEST(CrackGeometry, symmetric_in_its_arguments)
  {
    std::mt19937                           random(7);
    std::uniform_real_distribution<double> uniform(-1., 1.);
    std::uniform_int_distribution<int>     lattice(-4, 4);
    unsigned int                           n_cut = 0;
    const auto                             point = [&](const bool on_lattice) {
      return on_lattice ? Point<2>(lattice(random) / 4., lattice(random) / 4.) :
                                                      Point<2>(uniform(random), uniform(random));
    };
    for (unsigned int k = 0; k < 20000; ++k)
      {
        const bool     on_lattice = k % 2 == 0;
        const Point<2> a = point(on_lattice), b = point(on_lattice), c = point(on_lattice),
                       d = point(on_lattice);
        if (c == d)
          continue;
        const CrackGeometry<2> crack({c, d});
        ASSERT_EQ(crack.separates(a, b), crack.separates(b, a));
        n_cut += crack.separates(a, b) ? 1 : 0;
      }
    EXPECT_GT(n_cut, 1000u);
  }


  TEST(CrackGeometry, through_nodes_acts_as_one_shifted_to_the_right)
  {
    // All bonds of length up to 3 of a lattice, cracks through nodes in many directions.
    const std::vector<std::pair<Point<2>, Point<2>>> cracks = {{{1., 3.}, {6., 3.}},
                                                               {{6., 3.}, {1., 3.}},
                                                               {{3., 1.}, {3., 6.}},
                                                               {{1., 1.}, {6., 6.}},
                                                               {{6., 5.}, {2., 3.}},
                                                               {{1.5, 2.}, {4.5, 5.}}};
    for (const auto &[start, end] : cracks)
      {
        const CrackGeometry<2> crack({start, end});
        const auto             shift = -1e-9 * crack.normal();
        const CrackGeometry<2> shifted({start + shift, end + shift});
        unsigned int           n_cut = 0;
        for (int x = 0; x < 8; ++x)
          for (int y = 0; y < 8; ++y)
            for (int dx = -3; dx <= 3; ++dx)
              for (int dy = -3; dy <= 3; ++dy)
                {
                  const Point<2> a(x, y), b(x + dx, y + dy);
                  const bool     cut = crack.separates(a, b);
                  n_cut += cut ? 1 : 0;
                  ASSERT_EQ(cut, shifted.separates(a, b))
                    << "(" << a << ") (" << b << ") crack (" << start << ") (" << end << ")";
                }
        EXPECT_GT(n_cut, 50u);
      }
  }


  TEST(CrackGeometry, polygon_with_a_notch)
  {
    // An L in the plane z = 1: the square 0..2 without its upper right quarter.
    const std::vector<Point<3>> corners = {Point<3>(0., 0., 1.),
                                           Point<3>(2., 0., 1.),
                                           Point<3>(2., 1., 1.),
                                           Point<3>(1., 1., 1.),
                                           Point<3>(1., 2., 1.),
                                           Point<3>(0., 2., 1.)};
    const CrackGeometry<3>      crack(corners);
    EXPECT_DOUBLE_EQ(crack.measure(), 3.);
    EXPECT_NEAR(crack.normal()[2], 1., 1e-15);
    const auto cuts_at = [&](const double x, const double y) {
      const Point<3> a(x, y, 1.5), b(x, y, 0.5);
      EXPECT_EQ(crack.separates(a, b), crack.separates(b, a));
      return crack.separates(a, b);
    };
    EXPECT_TRUE(cuts_at(0.5, 0.5));
    EXPECT_TRUE(cuts_at(1.5, 0.5));
    EXPECT_TRUE(cuts_at(0.5, 1.5));
    EXPECT_FALSE(cuts_at(1.5, 1.5));
    EXPECT_FALSE(cuts_at(-0.1, 0.5));
    EXPECT_FALSE(cuts_at(2.1, 1.));
    // The edge cuts nothing: corners, edges, the notch's corner; just inside it does.
    for (const Point<3> &p : corners)
      EXPECT_FALSE(cuts_at(p[0], p[1])) << p;
    EXPECT_FALSE(cuts_at(1., 1.5));
    EXPECT_FALSE(cuts_at(1.5, 1.));
    EXPECT_FALSE(cuts_at(0., 1.));
    EXPECT_TRUE(cuts_at(1. - 1e-6, 1.5));
    EXPECT_TRUE(cuts_at(1e-6, 1.));
    // Unless it lies on the surface of the body.
    CrackGeometry<3> closed(corners);
    closed.close(5); // from (0, 2) to (0, 0)
    EXPECT_TRUE(closed.separates(Point<3>(0., 1., 1.5), Point<3>(0., 1., 0.5)));
    EXPECT_FALSE(closed.separates(Point<3>(1., 0., 1.5), Point<3>(1., 0., 0.5)));
    EXPECT_FALSE(cuts_at(1. + 1e-6, 1. + 1e-6));
    // Points on the polygon belong to the side of the right-hand normal; beyond it, nothing is cut.
    EXPECT_TRUE(crack.separates(Point<3>(0.5, 0.5, 1.), Point<3>(0.5, 0.5, 0.)));
    EXPECT_FALSE(crack.separates(Point<3>(0.5, 0.5, 1.), Point<3>(0.5, 0.5, 2.)));
    EXPECT_FALSE(crack.separates(Point<3>(0.5, 0.5, 1.), Point<3>(1.5, 0.5, 1.)));
    EXPECT_TRUE(crack.contains(Point<3>(1., 1., 1.)));
    EXPECT_FALSE(crack.contains(Point<3>(1.5, 1.5, 1.)));

    std::vector<Point<3>> reversed(corners.rbegin(), corners.rend());
    EXPECT_NEAR(CrackGeometry<3>(reversed).normal()[2], -1., 1e-15);
  }


  TEST(CrackGeometry, near_is_a_bounding_box_test)
  {
    const CrackGeometry<2> crack({Point<2>(0., 0.), Point<2>(2., 1.)});
    EXPECT_TRUE(crack.is_near(Point<2>(-0.5, 0.), 0.5));
    EXPECT_FALSE(crack.is_near(Point<2>(-0.6, 0.), 0.5));
    EXPECT_FALSE(crack.is_near(Point<2>(1., 1.6), 0.5));
  }
} // namespace PeriDeal
