// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/msh_file.h>

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "scene_test_tools.h"

using namespace PeriDeal;
using PeriDeal::SceneTests::message_of;

namespace
{
  using Place = std::array<double, 3>;

  MshMesh mesh_of(const unsigned int                            dim,
                  const std::vector<Place>                     &points,
                  const std::vector<std::vector<unsigned int>> &cells,
                  const std::vector<std::vector<unsigned int>> &sides = {})
  {
    MshMesh mesh;
    mesh.dim    = dim;
    mesh.points = points;
    for (unsigned int i = 0; i < points.size(); ++i)
      mesh.numbers.push_back(i + 1);
    for (const auto *const list : {&cells, &sides})
      for (const auto &nodes : *list)
        {
          MshElement element;
          element.number = 1 + mesh.cells.size() + mesh.sides.size();
          element.n      = nodes.size();
          element.id     = list == &sides ? 7 : 3;
          std::copy(nodes.begin(), nodes.end(), element.nodes.begin());
          (list == &cells ? mesh.cells : mesh.sides).push_back(element);
        }
    return mesh;
  }


  /** Divide a mesh: it stays a mesh, with the same volume and surface and no corner turned in. */
  void expect_division(MshMesh           mesh,
                       const std::size_t n_cells,
                       const double      volume,
                       const double      side)
  {
    check_msh(mesh, "part", mesh.dim);
    const double surface = mesh.surface;
    divide_msh(mesh, mesh.dim);
    EXPECT_EQ(mesh.cells.size(), n_cells);
    const MshQuality quality = quality_of_msh(mesh, mesh.dim);
    EXPECT_NEAR(quality.volume, volume, 1e-12 * volume);
    EXPECT_GT(quality.worst, 0.);
    EXPECT_LE(quality.smallest, quality.median);
    double measure = 0.;
    for (const MshElement &one : mesh.sides)
      {
        EXPECT_EQ(one.id, 7);
        EXPECT_EQ(one.n, mesh.dim == 2 ? 2u : 4u);
        const Place &a = mesh.points[one.nodes[0]], &b = mesh.points[one.nodes[mesh.dim - 1]],
                    &c = mesh.points[one.nodes[1]], &d = mesh.points[one.nodes[3]];
        Place u, v;
        for (unsigned int k = 0; k < 3; ++k)
          {
            u[k] = b[k] - a[k];
            v[k] = d[k] - c[k];
          }
        measure += mesh.dim == 2 ? std::hypot(u[0], u[1]) :
                                   0.5 * std::hypot(u[1] * v[2] - u[2] * v[1],
                                                    u[2] * v[0] - u[0] * v[2],
                                                    u[0] * v[1] - u[1] * v[0]);
      }
    EXPECT_NEAR(measure, side, 1e-12);
    for (unsigned int i = 0; i < mesh.cells.size(); ++i)
      mesh.cells[i].number = i + 1;
    mesh.surface = 0.;
    EXPECT_EQ(message_of([&] { check_msh(mesh, "part", mesh.dim); }), "");
    EXPECT_NEAR(mesh.surface, surface, 1e-12 * surface);
    EXPECT_TRUE(mesh.touching.empty());
  }


  const std::vector<Place> cube = {{{0, 0, 0}},
                                   {{1, 0, 0}},
                                   {{1, 1, 0}},
                                   {{0, 1, 0}},
                                   {{0, 0, 1}},
                                   {{1, 0, 1}},
                                   {{1, 1, 1}},
                                   {{0, 1, 1}}};
} // namespace


TEST(MshDivision, triangles_and_quadrilaterals)
{
  expect_division(mesh_of(2, {{{0, 0, 0}}, {{2, 0, 0}}, {{0, 1, 0}}}, {{0, 1, 2}}, {{0, 1}}),
                  3,
                  1.,
                  2.);
  // numbered clockwise, beside a quadrilateral
  expect_division(mesh_of(2,
                          {{{0, 0, 0}}, {{2, 0, 0}}, {{2, 1, 0}}, {{0, 1, 0}}, {{3, 0.5, 0}}},
                          {{0, 1, 2, 3}, {1, 2, 4}},
                          {{1, 4}, {2, 4}}),
                  7,
                  2.5,
                  2. * std::sqrt(1.25));
}


TEST(MshDivision, tetrahedra)
{
  expect_division(mesh_of(3, {cube[0], cube[1], cube[3], cube[4]}, {{0, 1, 2, 3}}, {{0, 2, 1}}),
                  4,
                  1. / 6.,
                  0.5);
  // Five in a cube, whose corners are moved.
  std::vector<Place>                     points = cube;
  std::mt19937                           generator(3);
  std::uniform_real_distribution<double> by(-0.2, 0.2);
  for (Place &p : points)
    for (double &x : p)
      x += by(generator);
  const std::vector<std::vector<unsigned int>> tets = {{0, 1, 3, 4},
                                                       {2, 3, 1, 6},
                                                       {5, 4, 6, 1},
                                                       {7, 6, 4, 3},
                                                       {1, 3, 4, 6}};
  MshMesh                                      mesh = mesh_of(3, points, tets);
  double                                       sum  = 0.;
  for (const auto &tet : tets)
    {
      double e[3][3];
      for (unsigned int k = 0; k < 3; ++k)
        for (unsigned int d = 0; d < 3; ++d)
          e[k][d] = points[tet[k + 1]][d] - points[tet[0]][d];
      sum += std::abs(e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
                      e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
                      e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0])) /
             6.;
    }
  expect_division(mesh, 20, sum, 0.);
}


TEST(MshDivision, wedges_and_hexahedra)
{
  // Two wedges make a cube: along z they stay whole. A hexahedron at their side goes with them.
  const std::vector<std::vector<unsigned int>> wedges = {{0, 1, 2, 4, 5, 6}, {0, 2, 3, 4, 6, 7}};
  expect_division(mesh_of(3, cube, wedges, {{0, 1, 2}, {0, 1, 5, 4}}), 6, 1., 1.5);
  std::vector<Place> more = cube;
  for (const Place &p : {Place{{2, 0, 0}}, Place{{2, 1, 0}}, Place{{2, 0, 1}}, Place{{2, 1, 1}}})
    more.push_back(p);
  std::vector<std::vector<unsigned int>> cells = wedges;
  cells.push_back({1, 8, 9, 2, 5, 10, 11, 6});
  expect_division(mesh_of(3, more, cells, {{8, 9, 11, 10}}), 10, 2., 1.);
  // A tetrahedron on top of a third wedge leaves them whole; one with an edge along z has all of
  // them
  // halved: 6 of a wedge, 8 of a hexahedron.
  more.push_back({{-1, 0.5, 0}});
  more.push_back({{-1, 0.5, 1}});
  more.push_back({{-0.5, 0.5, 2}});
  cells.push_back({12, 0, 3, 13, 4, 7});
  cells.push_back({13, 4, 7, 14});
  expect_division(mesh_of(3, more, cells), 6 + 4 + 3 + 4, 2. + 0.5 + 1. / 6., 0.);
  cells.push_back({12, 13, 15, 16}); // which has an edge along z
  more.push_back({{-2, 0, 0.5}});
  more.push_back({{-2, 1, 0.5}});
  expect_division(mesh_of(3, more, cells), 3 * 6 + 8 + 4 + 4, 2. + 0.5 + 1. / 6. + 1. / 6., 0.);
}
