// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/user_error.h>
#include <perideal/study/lattice_ladder.h>
#include <perideal/study/pareto.h>

#include <gtest/gtest.h>

#include <cmath>

namespace
{
  using namespace PeriDeal;

  using Kind = CostAtError::Kind;

  TEST(Pareto, FrontAndWhatDominates)
  {
    const std::vector<WorkPoint> points = {{10., 0.1},
                                           {5., 0.2},
                                           {20., 0.1},
                                           {7., 0.3},
                                           {40., 0.01},
                                           {5., 0.2},
                                           {50., 0.05},
                                           {5., 0.25}};
    EXPECT_TRUE(dominates(points[0], points[2]));  // as wrong, dearer
    EXPECT_TRUE(dominates(points[1], points[7]));  // as dear, more wrong
    EXPECT_FALSE(dominates(points[1], points[5])); // the same
    EXPECT_FALSE(dominates(points[0], points[1]));
    EXPECT_EQ(pareto_front(points), (std::vector<std::size_t>{1, 5, 0, 4}));
    EXPECT_EQ(dominating_points(points),
              (std::vector<std::size_t>{no_point, no_point, 0, 1, no_point, no_point, 4, 1}));
    EXPECT_TRUE(pareto_front({}).empty());
  }


  TEST(Pareto, TheCheapestOfThoseThatDominateIsNamed)
  {
    // Both of the front are better than the last; the first is the cheaper one.
    EXPECT_EQ(dominating_points({{1., 0.5}, {2., 0.1}, {3., 0.6}}),
              (std::vector<std::size_t>{no_point, no_point, 0}));
  }


  TEST(Pareto, OrdersAreThoseOfPowers)
  {
    EXPECT_NEAR(observed_order({0.4, 0.2, 0.1}, {0.32, 0.08, 0.02}), 2., 1e-12);
    EXPECT_NEAR(observed_order({0.2, 0.1}, {0.3, 0.15}), 1., 1e-12);
    EXPECT_TRUE(std::isnan(observed_order({0.1}, {0.1})));
    EXPECT_TRUE(std::isnan(observed_order({0.1, 0.1}, {0.1, 0.2})));
    EXPECT_TRUE(std::isnan(observed_order({0.2, 0.1}, {0.1, 0.})));
    EXPECT_NEAR(order_of_differences(0.4, 0.1), 2., 1e-12);
    // 3 + 5 h^1.5 on h = 2, 1
    EXPECT_NEAR(richardson({3. + 5. * std::pow(2., 1.5)}, {8.}, 1.5)[0], 3., 1e-12);
  }


  TEST(Pareto, CostOfAnErrorAlongAFamily)
  {
    // error = 100/cost
    const std::vector<WorkPoint> family = {{100., 1.}, {1000., 0.1}, {10000., 0.01}};
    CostAtError                  cost   = cost_at_error(family, 0.05);
    EXPECT_EQ(cost.kind, Kind::interpolated);
    EXPECT_NEAR(cost.cost, 2000., 1e-9);
    cost = cost_at_error(family, 0.1);
    EXPECT_NEAR(cost.cost, 1000., 1e-9);
    EXPECT_EQ(cost_at_error(family, 0.0009).kind, Kind::none); // too far
    cost = cost_at_error(family, 0.001);
    EXPECT_EQ(cost.kind, Kind::extrapolated);
    EXPECT_NEAR(cost.cost, 1e5, 1e-6);
    EXPECT_NEAR(cost.beyond, 10., 1e-12);
    cost = cost_at_error(family, 2.);
    EXPECT_EQ(cost.kind, Kind::at_most);
    EXPECT_EQ(cost.cost, 100.);
    // A lucky coarse point does not count.
    cost = cost_at_error({{1., 0.01}, {10., 0.2}, {100., 0.02}}, 0.05);
    EXPECT_EQ(cost.kind, Kind::interpolated);
    EXPECT_GT(cost.cost, 10.);
    // Two that cost the same, as wall times may; one that costs less.
    for (const double first : {10., 12.})
      {
        cost = cost_at_error({{first, 0.2}, {10., 0.05}, {40., 0.02}}, 0.1);
        EXPECT_EQ(cost.kind, Kind::at_most);
        EXPECT_EQ(cost.cost, 10.);
      }
    // No gain at the end, one point, none.
    EXPECT_EQ(cost_at_error({{1., 0.2}, {10., 0.2}}, 0.1).kind, Kind::none);
    EXPECT_EQ(cost_at_error({{1., 0.2}}, 0.1).kind, Kind::none);
    EXPECT_EQ(cost_at_error({}, 0.1).kind, Kind::none);
  }


  TEST(LatticeLadder, LatticesFromTheCommandLine)
  {
    EXPECT_EQ(parse_ladder(" 21, 21|41,41 | 81, 81 ", "--cells", 2, 2),
              (std::vector<CellCounts>{{21, 21}, {41, 41}, {81, 81}}));
    EXPECT_EQ(parse_ladder("4,5,6", "--cells", 3, 1), (std::vector<CellCounts>{{4, 5, 6}}));
    for (const char *const wrong : {"",
                                    "21, 21",
                                    "21 | 41",
                                    "21, x | 41, 41",
                                    "21, 21 | 21, 41",
                                    "0, 2 | 3, 3",
                                    "21, 21 | 41, 41, 41",
                                    "-2, 4 | 8, 8"})
      EXPECT_THROW(parse_ladder(wrong, "--cells", 2, 2), UserError) << wrong;
  }


  TEST(LatticeLadder, HalvingKeepsOddAndEven)
  {
    EXPECT_EQ(default_ladder({161, 161}, 4),
              (std::vector<CellCounts>{{21, 21}, {41, 41}, {81, 81}, {161, 161}}));
    EXPECT_EQ(default_ladder({160, 81}, 4),
              (std::vector<CellCounts>{{20, 11}, {40, 21}, {80, 41}, {160, 81}}));
    EXPECT_EQ(default_ladder({20, 20}, 4), (std::vector<CellCounts>{{10, 10}, {20, 20}}));
    EXPECT_EQ(default_ladder({6, 6}, 4), (std::vector<CellCounts>{{6, 6}}));
  }


  CrackedBox plate()
  {
    CrackedBox box;
    box.lower  = {-1., -1.};
    box.upper  = {1., 1.};
    box.cells  = {41, 41};
    box.cracks = {{{-0.5, 0.}, {0.5, 0.}}};
    return box;
  }


  TEST(LatticeLadder, NearestLatticeWithCracksOnFaces)
  {
    CrackedBox box = plate();
    EXPECT_TRUE(along_axes(box));
    EXPECT_EQ(*nearest_fitting(box, {41, 41}, true, 1), (CellCounts{40, 40}));
    EXPECT_EQ(*nearest_fitting(box, {22, 22}, true, 1), (CellCounts{20, 22}));
    EXPECT_EQ(*nearest_fitting(box, {41, 41}, false, 1), (CellCounts{41, 41}));
    EXPECT_EQ(*nearest_fitting(box, {41, 41}, false, 8), (CellCounts{40, 40}));
    // the largest cells, twice as large, have to have the crack on their faces: 0.5 is a multiple
    // of 2/20, but not of 2/18
    EXPECT_EQ(*nearest_fitting(box, {37, 37}, true, 2), (CellCounts{40, 36}));
    box.cracks = {{{-0.5, 0.}, {3., 0.}}}; // leaves the box
    EXPECT_EQ(*nearest_fitting(box, {41, 41}, true, 1), (CellCounts{40, 40}));
    box.cracks = {{{-0.5, 0.}, {0.5, 0.1}}};
    EXPECT_FALSE(along_axes(box));
    EXPECT_FALSE(nearest_fitting(box, {41, 41}, true, 1));
    box.cracks = {{{-std::sqrt(0.2), 0.}, {0.5, 0.}}};
    EXPECT_FALSE(nearest_fitting(box, {41, 41}, true, 1));
    // 3D: a square normal to z, and one that is turned
    CrackedBox body;
    body.lower  = {0., 0., 0.};
    body.upper  = {1., 1., 1.};
    body.cells  = {9, 9, 9};
    body.cracks = {{{0.25, 0.25, 0.5}, {0.75, 0.25, 0.5}, {0.75, 0.75, 0.5}, {0.25, 0.75, 0.5}}};
    EXPECT_EQ(*nearest_fitting(body, body.cells, true, 1), (CellCounts{8, 8, 8}));
    body.cracks = {{{0.5, 0.25, 0.5}, {0.75, 0.5, 0.5}, {0.5, 0.75, 0.5}, {0.25, 0.5, 0.5}}};
    EXPECT_FALSE(along_axes(body));
  }


  TEST(LatticeLadder, BondsOfAWholeBody)
  {
    // 36 neighbours nearer than 3.5 spacings
    EXPECT_EQ(estimated_bonds(plate(), {41, 41}, 3.), 0.5 * 42 * 42 * 36);
  }


  TEST(LatticeLadder, ErrorsAreWeightedByNodalVolumes)
  {
    // A 2 x 2 lattice: the middle counts four times as much as a corner, twice as much as a side.
    const std::vector<double> one(9, 1.);
    std::vector<double>       values = one;
    values[4]                        = 2.;
    EXPECT_NEAR(nodal_error(values, one, {2, 2}), std::sqrt(1. / 4.), 1e-14);
    values    = one;
    values[0] = 2.;
    EXPECT_NEAR(nodal_error(values, one, {2, 2}), std::sqrt(1. / 16.), 1e-14);
    EXPECT_NEAR(nodal_error(one, std::vector<double>(9, 0.), {2, 2}), 1., 1e-14);
  }
} // namespace
