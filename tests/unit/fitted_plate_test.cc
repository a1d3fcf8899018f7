// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/bounding_box.h>

#include <perideal/base/user_error.h>
#include <perideal/mesh/fitted_plate.h>

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

using namespace PeriDeal;
using dealii::Point;

namespace
{
  /** What a mesh of a plate is: its area, the length of its rims, its worst corner. */
  struct Measured
  {
    double area = 0., rim = 0., sine = 1., off_rim = 0.;
    bool   is_whole = true; // each edge in one or two cells
  };

  Measured measured(const FittedPlate &plate, const std::vector<Hole> &holes)
  {
    Measured                                                      found;
    std::map<std::pair<unsigned int, unsigned int>, unsigned int> n_cells;
    for (const auto &cell : plate.cells)
      for (unsigned int k = 0; k < 4; ++k)
        {
          const Point<2> &p = plate.vertices[cell[k]], &a = plate.vertices[cell[(k + 1) % 4]],
                         &b = plate.vertices[cell[(k + 3) % 4]];
          const double turn = (a - p)[0] * (b - p)[1] - (a - p)[1] * (b - p)[0];
          found.area += 0.25 * turn; // of a quadrilateral all four make twice the area
          found.sine = std::min(found.sine, turn / (p.distance(a) * p.distance(b)));
          ++n_cells[std::minmax(cell[k], cell[(k + 1) % 4])];
        }
    const auto [lower, upper] = dealii::BoundingBox<2>(plate.vertices).get_boundary_points();
    for (const auto &[edge, n] : n_cells)
      {
        found.is_whole    = found.is_whole && n < 3;
        const Point<2> &a = plate.vertices[edge.first], &b = plate.vertices[edge.second];
        const Point<2>  middle = a + 0.5 * (b - a);
        bool            on_rim = n == 1; // not on a side of the rectangle
        for (unsigned int d = 0; d < 2; ++d)
          on_rim = on_rim && std::min(middle[d] - lower[d], upper[d] - middle[d]) > 1e-12;
        if (!on_rim)
          continue;
        found.rim += a.distance(b);
        double off = 1.;
        for (const Hole &hole : holes)
          off = std::min(off, std::abs(hole.distance(a)));
        found.off_rim = std::max(found.off_rim, off);
      }
    return found;
  }

  FittedPlate plate_with(const std::vector<Hole> &holes, const unsigned int n)
  {
    return fitted_plate({0., 0.}, {2., 1.}, {{2 * n, n}}, holes, "'Rims' in section 'Domain'");
  }
} // namespace


TEST(FittedPlates, round_holes_of_any_place_and_size)
{
  for (const double x : {0.7, 0.734, 1.01})
    for (const double radius : {0.13, 0.2, 0.27})
      for (unsigned int n = 9; n < 24; n += 2)
        {
          const std::vector<Hole> holes =
            parse_holes("circle: " + std::to_string(x) + ", 0.48, " + std::to_string(radius), "");
          const Measured found = measured(plate_with(holes, n), holes);
          const double   pi    = std::acos(-1.);
          EXPECT_TRUE(found.is_whole);
          EXPECT_GT(found.sine, 0.25) << x << " " << radius << " " << n;
          EXPECT_LT(found.off_rim, 1e-12);
          // A polygon of k corners lacks about (2 pi^2 / 3 k^2) of the area of its circle.
          EXPECT_NEAR(found.rim, 2. * pi * radius, 0.12 * radius);
          EXPECT_NEAR(found.area, 2. - pi * radius * radius, 0.2 * radius * radius);
        }
}


TEST(FittedPlates, polygons_keep_their_corners)
{
  const std::vector<Hole> holes =
    parse_holes("polygon: 0.5, 0.3, 0.95, 0.4, 0.8, 0.75 ; polygon: 1.3,0.5, 1.5,0.3, 1.7,0.5, "
                "1.5,0.7",
                "");
  for (unsigned int n = 14; n < 40; n += 5)
    {
      const Measured found  = measured(plate_with(holes, n), holes);
      const double   length = holes[0].rim_length() + holes[1].rim_length();
      EXPECT_TRUE(found.is_whole);
      EXPECT_GT(found.sine, 0.3) << n;
      EXPECT_NEAR(found.rim, length, 1e-12);
      EXPECT_NEAR(found.area, 2. - holes[0].area() - holes[1].area(), 1e-12);
    }
}


TEST(FittedPlates, no_hole_is_lost_in_oblong_cells)
{
  const std::vector<Hole> holes = parse_holes("circle: 5.25, 0.5, 0.2", "");
  for (const unsigned int n : {10u, 15u, 22u})
    {
      const FittedPlate plate =
        fitted_plate({0., 0.}, {10., 1.}, {{n, 10}}, holes, "'Rims' in section 'Domain'");
      const Measured found = measured(plate, holes);
      EXPECT_TRUE(found.is_whole);
      EXPECT_NEAR(found.area, 10. - std::acos(-1.) * 0.04, 0.02);
      EXPECT_GT(found.sine, 0.1);
    }
}


TEST(FittedPlates, rectangles_on_lines_of_the_lattice_are_cut_out)
{
  const std::vector<Hole> holes =
    parse_holes("rectangle: 1, 0.5, 2, 1 ; rectangle: 0.25, 0.25, 0.5, 0.75", "");
  const FittedPlate plate = plate_with(holes, 4);
  EXPECT_EQ(plate.cells.size(), 8u * 4u - 8u - 2u);
  EXPECT_NEAR(measured(plate, holes).area, 2. - 0.5 - 0.125, 1e-14);
}


TEST(FittedPlates, holes_that_cells_are_too_large_for_are_told)
{
  const auto message = [](const std::string &text, const unsigned int n) -> std::string {
    const std::vector<Hole> holes = parse_holes(text, "");
    try
      {
        plate_with(holes, n);
      }
    catch (const UserError &error)
      {
        return error.message();
      }
    return "";
  };
  EXPECT_NE(message("circle: 0.5, 0.2, 0.19", 10).find("a side of the plate"), std::string::npos);
  EXPECT_NE(message("circle: 0.5, 0.5, 0.2 ; circle: 0.95, 0.5, 0.2", 8).find("circle: 0.95"),
            std::string::npos);
  EXPECT_EQ(message("circle: 0.5, 0.5, 0.2 ; circle: 0.95, 0.5, 0.2", 80), "");
  EXPECT_NE(message("circle: 2.5, 0.5, 0.1", 10).find("outside the plate"), std::string::npos);
  EXPECT_EQ(message("polygon: 0.35, 0.35, 0.65, 0.35, 0.35, 0.65", 16), ""); // 45 degrees
}
