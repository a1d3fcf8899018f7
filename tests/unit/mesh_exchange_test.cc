// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/analysis/coupling_certificate.h>
#include <perideal/mesh/cell_geometry.h>
#include <perideal/mesh/cell_paths.h>
#include <perideal/operators/coupling/mesh_exchange.h>

#include <algorithm>
#include <map>
#include <random>

#include "distorted_mesh.h"
#include "growth_test_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;

namespace
{
  template <int dim>
  Settings on(const std::string &mesh, const std::string &horizon, const std::string &zone)
  {
    return {{"Domain/Shape", "mesh file"},
            {"Domain/Mesh file", mesh},
            {"Peridynamics/Horizon", horizon},
            {"Coupling/Zone", zone}};
  }


  template <int dim>
  double kept_share(const Problem<dim> &problem)
  {
    return dynamic_cast<const MeshExchange<dim, ConductingBonds<dim>> &>(
             cells_of(problem.op()).bonds())
      .kept_share();
  }


  template <int dim>
  void check(const std::string &mesh, const std::string &horizon, const double least_kept)
  {
    for (const std::string zone : {"everywhere",
                                   "0.3 - max(abs(x - 0.5), abs(y - 0.5))",
                                   "0.55 - x",
                                   "sin(4375.85*x + 1234.5*y + 777.7*z + 2) + 0.2"})
      {
        const Problem<dim>        problem(on<dim>(mesh, horizon, zone), ModelKind::coupled);
        const CouplingCertificate found = examine_coupling(problem.op(), true);
        EXPECT_LT(found.linear, 1e-12) << zone;
        EXPECT_LT(found.asymmetry, 1e-13) << zone;
        EXPECT_GT(found.lowest_remainder, -1e-13) << zone;
        EXPECT_GT(found.lowest_eigenvalue, 0.) << zone;
        EXPECT_GT(problem.op().size().bonds, 0u) << zone;
        EXPECT_GT(kept_share(problem), least_kept) << zone;
        Vector one = problem.values([](const dealii::Point<dim> &) { return 1.; }), image = one;
        problem.op().multiply(image, one);
        EXPECT_LT(image.linfty_norm() / problem.op().diagonal().linfty_norm(), 1e-13) << zone;
      }
  }
} // namespace


TEST(CellGeometry, unit_points_and_crossings)
{
  const CellCorners<3>   cell{{{0., 0., 0.},
                               {1.1, 0.1, 0.},
                               {-0.1, 0.9, 0.1},
                               {1., 1.2, 0.},
                               {0.1, 0., 1.},
                               {1., 0.05, 1.1},
                               {0., 1., 0.9},
                               {1.1, 1., 1.05}}};
  const dealii::Point<3> unit(0.3, 0.8, 0.4);
  dealii::Point<3>       p, found;
  const auto             values = shape_values(unit);
  for (unsigned int v = 0; v < values.size(); ++v)
    p += values[v] * (cell[v] - dealii::Point<3>());
  ASSERT_TRUE(unit_point(cell, p, found));
  EXPECT_LT(found.distance(unit), 1e-14);
  // From the middle a ray leaves through one face; where it does, one unit coordinate is 0 or 1.
  for (const dealii::Point<3> &end : {dealii::Point<3>(3., 0.4, 0.7),
                                      dealii::Point<3>(0.4, -2., 0.3),
                                      dealii::Point<3>(0.4, 0.5, 4.)})
    {
      std::vector<double> places;
      add_face_crossings(cell, p, end, places);
      unsigned int n_ahead = 0;
      for (const double s : places)
        if (s > 0.)
          {
            ++n_ahead;
            ASSERT_TRUE(unit_point(cell, p + s * (end - p), found));
            double nearest = 1.;
            for (unsigned int d = 0; d < 3; ++d)
              nearest = std::min({nearest, std::abs(found[d]), std::abs(found[d] - 1.)});
            EXPECT_LT(nearest, 1e-12);
          }
      EXPECT_EQ(n_ahead, 1u);
    }
}


namespace
{
  /**
   * Follows all paths up to a length in a random mesh of n^dim cells in both ways.
   * Part of it is not distorted, and it has a notch. Returns the share of paths that were walked.
   */
  template <int dim>
  double compare_paths(const unsigned int n, const double part, const double reach)
  {
    constexpr unsigned int                 n_corners = dealii::GeometryInfo<dim>::vertices_per_cell;
    std::mt19937                           random(11);
    std::uniform_real_distribution<double> shift(-part, part);
    std::vector<dealii::Point<dim>>        nodes;
    std::vector<PathCell<dim>>             cells;
    const unsigned int                     n_z = dim == 3 ? n : 0;
    for (unsigned int k = 0; k <= n_z; ++k)
      for (unsigned int j = 0; j <= n; ++j)
        for (unsigned int i = 0; i <= n; ++i)
          {
            const unsigned int at[3] = {i, j, k};
            dealii::Point<dim> p;
            // Flat outer faces, and one quarter of the mesh not distorted: paths along faces, edges
            // and through vertices.
            const bool regular = 2 * i <= n && 2 * j <= n;
            for (unsigned int d = 0; d < dim; ++d)
              p[d] = at[d] + (at[d] > 0 && at[d] < n && !regular ? shift(random) : 0.);
            nodes.push_back(p);
          }
    const auto missing = [&](const unsigned int i, const unsigned int j) {
      return i == n - 2 && j >= n - 2; // a notch
    };
    for (unsigned int k = 0; k < std::max(1u, n_z); ++k)
      for (unsigned int j = 0; j < n; ++j)
        for (unsigned int i = 0; i < n; ++i)
          {
            PathCell<dim> cell;
            for (unsigned int v = 0; v < n_corners; ++v)
              {
                cell.nodes[v] =
                  i + (v & 1) + (n + 1) * (j + ((v >> 1) & 1) + (n + 1) * (k + ((v >> 2) & 1)));
                cell.corners[v] = nodes[cell.nodes[v]];
              }
            if (!missing(i, j))
              cells.push_back(cell);
          }
    CellPaths<dim>                              paths(cells, nodes, reach, true);
    std::vector<typename CellPaths<dim>::Piece> walked, plain;
    double                                      worst   = 0.;
    std::size_t                                 n_paths = 0, n_leaving = 0;
    for (unsigned int a = 0; a < nodes.size(); ++a)
      for (unsigned int b = 0; b < nodes.size(); ++b)
        {
          if (a == b || nodes[a].distance(nodes[b]) > reach)
            continue;
          ++n_paths;
          const PathEnd<dim> from{a, nodes[a], nodes[a]}, to{b, nodes[b], nodes[b]};
          const bool         one = paths.follow(from, to, walked);
          EXPECT_EQ(one, paths.follow_plainly(from, to, plain));
          n_leaving += !one;
          if (!one)
            continue;
          // The general way may cut a piece along an edge once more: what each cell has of the path
          // is the same.
          std::map<unsigned int, std::array<double, n_corners * n_corners>> difference;
          for (const auto *const way : {&walked, &plain})
            for (const auto &piece : *way)
              for (unsigned int v = 0; v < n_corners * n_corners; ++v)
                difference[piece.cell][v] += (way == &walked ? 1. : -1.) *
                                             piece.change[v / n_corners] *
                                             piece.change[v % n_corners];
          for (const auto &[cell, matrix] : difference)
            for (const double x : matrix)
              worst = std::max(worst, std::abs(x));
        }
    EXPECT_LT(worst, 1e-10);
    EXPECT_GT(n_leaving, 0u);
    return 1. - paths.n_followed_plainly() / static_cast<double>(n_paths);
  }
} // namespace


TEST(CellPaths, walked_as_followed_plainly)
{
  EXPECT_GT(compare_paths<2>(16, 0.25, 3.6), 0.9);
  EXPECT_GT(compare_paths<3>(7, 0.1, 3.1), 0.8);
}


TEST(MeshExchange, quadrilaterals_distorted_by_30_percent)
{
  check<2>(distorted_mesh<2>(12, 0.3), "0.25", 0.3);
}


TEST(MeshExchange, hexahedra_distorted_by_10_percent)
{
  check<3>(distorted_mesh<3>(6, 0.1), "0.4", 0.3);
}


/**
 * Outside of the zone cells may be larger than the horizon; the bonds of the zone conduct on
 * average what the material does.
 */
TEST(MeshExchange, calibrated_over_the_zone)
{
  const Problem<2> problem(
    on<2>(distorted_mesh<2>(16, 0.1, 1.5), "0.075", "0.1 - max(abs(x - 0.5), abs(y - 0.5))"),
    ModelKind::coupled);
  EXPECT_LT(examine_coupling(problem.op(), true).linear, 1e-12);
  const Families<2>                        &families = cells_of(problem.op()).bonds().families();
  const Nodes<2>                           &nodes    = families.nodes();
  std::vector<typename Families<2>::Member> bonds;
  double                                    sum = 0., n = 0.;
  for (unsigned int i = 0; i < nodes.n_owned(); ++i)
    {
      if (!cells_of(problem.op()).bonds().in_zone(i))
        continue;
      families.members_of(i, bonds);
      for (const auto &bond : bonds)
        sum += bond.weight * families.neighbors().bond_vector(i, bond.neighbor).norm_square() /
               (4. * nodes.volume(i));
      n += 1.;
    }
  sum = sum_of_all(sum);
  n   = sum_of_all(n);
  EXPECT_GT(n, 20.);
  EXPECT_NEAR(sum / n, 1., 1e-12);
}


TEST(MeshExchange, crack_cut_into_the_mesh)
{
  const Settings   shape{{"Domain/Cells", "16, 16"},
                       {"Cracks/Segments", "0.25,0.5 ; 0.75,0.5"},
                       {"Cracks/Mesh", "faces"},
                       {"Coupling/Zone", "everywhere"}};
  const Problem<2> problem(shape, ModelKind::coupled), elements(shape, ModelKind::finite_elements);
  const CouplingCertificate found = examine_coupling(problem.op(), true);
  EXPECT_LT(found.linear, 1e-12);
  EXPECT_GT(found.lowest_remainder, -1e-13);
  EXPECT_GT(problem.op().size().bonds, 1000u);
}


namespace
{
  /** The same on all processes together and on one alone. */
  void compare_processes(const Settings &settings)
  {
    if (n_processes() == 1)
      return;
    const Problem<2> all(settings, ModelKind::coupled),
      alone(settings, ModelKind::coupled, MPI_COMM_SELF);
    EXPECT_LT(difference(all,
                         all.product(all.values(bumpy<2>)),
                         alone,
                         alone.product(alone.values(bumpy<2>))),
              1e-13 * alone.op().diagonal().linfty_norm());
    EXPECT_EQ(all.op().size().bonds, alone.op().size().bonds);
    EXPECT_NEAR(kept_share(all), kept_share(alone), 1e-13);
  }


  /**
   * A square of edge 5 with 20 x 20 cells, turned by an angle, with coordinates of so many digits:
   * its sides are not quite straight. Five digits are up to 6e-5 of a cell.
   */
  std::string turned_mesh(const double degrees, const unsigned int n_digits)
  {
    const double c = std::cos(degrees * std::acos(-1.) / 180.), s = std::sqrt(1. - c * c);
    return lattice_mesh<2>(
      "turned",
      20,
      [&](const std::array<unsigned int, 3> &at) {
        const double x = 5. * at[0] / 20., y = 5. * at[1] / 20.;
        return std::array<double, 3>{c * x - s * y, s * x + c * y, 0.};
      },
      n_digits);
  }
} // namespace


TEST(MeshExchange, same_on_all_processes)
{
  compare_processes(on<2>(distorted_mesh<2>(12, 0.3), "0.25", "0.55 - x") +
                    Settings{{"Cracks/Segments", "0.2,0.31 ; 0.71,0.52"}});
}


/**
 * Whether a bond along a side stays in the body is a matter of round-off of the mesh file: then too
 * it is the same from both ends and everywhere.
 */
TEST(MeshExchange, sides_that_are_not_quite_straight)
{
  std::size_t n_bonds = 0;
  for (const unsigned int n_digits : {16u, 7u, 5u, 3u})
    for (const double degrees : {20., 37., 47., 53.})
      {
        const Settings   settings = on<2>(turned_mesh(degrees, n_digits), "0.8", "everywhere");
        const Problem<2> problem(settings, ModelKind::coupled);
        const CouplingCertificate found = examine_coupling(problem.op(), true);
        EXPECT_LT(found.linear, 1e-12) << degrees << ", " << n_digits;
        EXPECT_LT(found.asymmetry, 1e-13) << degrees << ", " << n_digits;
        compare_processes(settings);
        if (n_digits == 16)
          n_bonds = problem.op().size().bonds;
        if (n_digits > 3) // to 1e-4 of a cell sides count as straight
          {
            EXPECT_EQ(problem.op().size().bonds, n_bonds) << degrees << ", " << n_digits;
          }
      }
}


/** A crack that grows through a distorted mesh, and the zone with it. */
TEST(MeshExchange, moving_zone_ends_where_a_new_operator_starts)
{
  const std::string mesh = distorted_mesh<2>(20, 0.25);
  const Settings    growing{{"Cracks/Segments", "0.2,0.43 ; 0.4,0.48"},
                         {"Cracks/Growth", "2: 0, 0.4,0.1, 0.9"},
                         {"Cracks/Growth step", "0.0125"},
                         {"Time/End time", "1"}},
    at_end{{"Cracks/Segments", "0.2,0.43 ; 0.76,0.57"}};
  for (const std::string zone : {"cracks: 1", "cracks: 0.4", "everywhere"})
    for (const std::string correction : {"none", "crack scaling"})
      {
        const Settings base =
          on<2>(mesh, "0.15", zone) + Settings{{"Peridynamics/Surface correction", correction},
                                               {"Boundary conditions/Convection", "0: 2, 1"}};
        expect_grown<2>(zone + ", " + correction, base, growing, at_end, ModelKind::coupled);
      }
  for (const std::string zone : {"cracks: 1", "cracks: 0.4"})
    {
      const Problem<2> problem(on<2>(mesh, "0.15", zone) + growing, ModelKind::coupled);
      EXPECT_GT(expect_history_kept(problem, zone), 0u) << zone;
    }
}
