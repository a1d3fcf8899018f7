// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/bonds/bond_pieces.h>
#include <perideal/scene/zone.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace PeriDeal;

namespace
{
  /**
   * A linear field changes along each piece by what it changes along that part of the bond, in each
   * of the cells around.
   */
  template <int dim>
  void check_linear_fields(const std::array<int, dim> &offset)
  {
    double length = 0.;
    for (const BondPiece<dim> &piece : bond_pieces<dim>(offset))
      {
        length += piece.length;
        EXPECT_FALSE(piece.cells.empty());
        for (unsigned int c = 0; c < piece.cells.size(); ++c)
          for (unsigned int d = 0; d < dim; ++d)
            {
              double change = 0., sum = 0.;
              for (unsigned int a = 0; a < piece.change[c].size(); ++a)
                {
                  sum += piece.change[c][a];
                  change +=
                    piece.change[c][a] * (piece.cells[c][d] + static_cast<int>((a >> d) & 1));
                }
              EXPECT_NEAR(change, piece.length * offset[d], 1e-14);
              EXPECT_NEAR(sum, 0., 1e-14);
            }
      }
    EXPECT_NEAR(length, 1., 1e-14);
  }
} // namespace


TEST(BondPieces, linear_fields)
{
  check_linear_fields<1>({3});
  check_linear_fields<2>({3, 2});
  check_linear_fields<2>({-3, 2});
  check_linear_fields<2>({0, 4});
  check_linear_fields<2>({2, 2});
  check_linear_fields<3>({1, -2, 3});
  check_linear_fields<3>({0, 0, 2});
  check_linear_fields<3>({0, 1, -1});
}


TEST(BondPieces, cells_around)
{
  const auto along_edge = bond_pieces<2>({0, 2});
  ASSERT_EQ(along_edge.size(), 2u);
  EXPECT_EQ(along_edge[1].cells.size(), 2u);
  EXPECT_EQ(along_edge[1].cells[0], (std::array<int, 2>{-1, 1}));
  EXPECT_EQ(along_edge[1].cells[1], (std::array<int, 2>{0, 1}));
  EXPECT_EQ(bond_pieces<2>({2, 2}).size(), 2u); // through a corner: no piece beside it
  EXPECT_EQ(bond_pieces<2>({-2, 1})[1].cells[0], (std::array<int, 2>{-2, 0}));
  EXPECT_EQ(bond_pieces<3>({0, 0, 1})[0].cells.size(), 4u);
  EXPECT_EQ(bond_pieces<3>({0, 1, 1})[0].cells.size(), 2u);
}


TEST(Zone, distance_to_pieces)
{
  using dealii::Point;
  EXPECT_NEAR(distance_to_piece<2>({{0., 0.}, {1., 0.}}, {0.5, 0.25}), 0.25, 1e-15);
  EXPECT_NEAR(distance_to_piece<2>({{0., 0.}, {1., 0.}}, {4., 4.}), 5., 1e-15);
  EXPECT_NEAR(distance_to_piece<2>({{1., 0.}, {1., 0.}}, {4., 4.}),
              5.,
              1e-15); // a crack that starts as a point
  const std::vector<Point<3>> square{{0., 0., 0.}, {1., 0., 0.}, {1., 1., 0.}, {0., 1., 0.}};
  EXPECT_NEAR(distance_to_piece<3>(square, {0.5, 0.4, -0.3}), 0.3, 1e-15);
  EXPECT_NEAR(distance_to_piece<3>(square, {4., 0.5, 4.}), 5., 1e-15);
  // An L: the point above the missing quarter is nearest to its inner edges.
  const std::vector<Point<3>> corner{{0., 0., 0.},
                                     {2., 0., 0.},
                                     {2., 1., 0.},
                                     {1., 1., 0.},
                                     {1., 2., 0.},
                                     {0., 2., 0.}};
  EXPECT_NEAR(distance_to_piece<3>(corner, {1.3, 1.5, 0.4}), 0.5, 1e-15);
}
