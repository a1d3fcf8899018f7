// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "dimensions.h"
#include "zone_breaking_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;
using dealii::Point;
using dealii::Tensor;

namespace
{
  template <int dim>
  Settings breakable(const std::string &zone, const double nu)
  {
    return zoned<dim>(zone, nu) + Settings{{"Material/Critical stretch", "0.01"}};
  }


  /** All active bonds for which choose(first place, second place) holds, on all processes alike. */
  template <int dim, typename Choose>
  std::vector<NodePair> pairs_of(const Body<dim> &body, const Choose &choose)
  {
    std::vector<NodePair>                     own;
    std::vector<typename Coupling<dim>::Bond> bonds;
    const auto                               &layout = *body.nodes->partitioner();
    for (unsigned int i = 0; i < body.nodes->n_owned(); ++i)
      {
        body.elements->bonds().bonds_of(i, bonds);
        for (const auto &bond : bonds)
          {
            NodePair pair{layout.local_to_global(i), layout.local_to_global(bond.neighbor)};
            if (pair[0] < pair[1] && choose(bond, body.position(i), body.position(bond.neighbor)))
              own.push_back(pair);
          }
      }
    return pairs_of_all(own);
  }


  template <int dim>
  void check_a_fifth_broken(const std::string &zone, const double nu)
  {
    Body<dim> body(breakable<dim>(zone, nu) + warm, ModelKind::coupled);
    check_a_fifth_broken(body, pairs_of(body, [](const auto &, const auto &a, const auto &b) {
                           return is_chosen<dim>(a, b);
                         }));
  }


  /**
   * K of a body in which all bonds across a crack have been broken, and of one with that crack: the
   * same but for cells in which the crack ends without cutting an edge of them.
   * @param to_end distance from where the crack ends
   */
  template <int dim>
  void check_made_crack(const std::string                               &entry,
                        const std::string                               &crack,
                        const std::string                               &zone,
                        const std::function<double(const Point<dim> &)> &to_end)
  {
    Body<dim> given(breakable<dim>(zone, 0.3) + Settings{{"Cracks/" + entry, crack}},
                    ModelKind::coupled),
      made(breakable<dim>(zone, 0.3), ModelKind::coupled);
    const auto across =
      pairs_of(given, [](const auto &bond, const auto &, const auto &) { return bond.cut; });
    ASSERT_FALSE(across.empty());
    const Vector u = made.values(bumpy_vector<dim>);
    made.elements->break_bonds(broken(across), u, 0.);
    Vector       y    = given.product(u);
    const double size = y.linfty_norm(), within = std::sqrt(1. * dim) * 0.1 * (1. + 1e-9);
    y -= made.product(u);
    unsigned int n_compared = 0;
    for (unsigned int i = 0; i < made.nodes->n_owned(); ++i)
      for (unsigned int d = 0; d < dim && to_end(made.position(i)) > within; ++d, ++n_compared)
        EXPECT_LT(std::abs(y.local_element(dim * i + d)), 1e-12 * size) << made.position(i);
    EXPECT_GT(sum_of_all(n_compared), 0.6 * y.size());
    EXPECT_EQ(made.elements->size().bonds, given.elements->size().bonds);
  }
} // namespace


TEST(ZoneBreaking, stays_sound_with_a_fifth_of_the_bonds_broken)
{
  for (const double nu : {-0.2, 0., 0.3, 0.45})
    {
      check_a_fifth_broken<2>("everywhere", nu);
      check_a_fifth_broken<2>("x - 0.55", nu);
    }
  for (const double nu : {0., 0.25, 0.45})
    {
      check_a_fifth_broken<3>("everywhere", nu);
      check_a_fifth_broken<3>("x - 0.25", nu);
    }
}


TEST(ZoneBreaking, crack_made_of_broken_bonds_is_the_prescribed_one)
{
  const auto of_points = [](const Point<2> &a, const Point<2> &b) {
    return [a, b](const Point<2> &p) { return std::min(a.distance(p), b.distance(p)); };
  };
  const auto segment = [&](const Point<2> &a, const Point<2> &b, const std::string &zone) {
    check_made_crack<2>("Segments",
                        std::to_string(a[0]) + "," + std::to_string(a[1]) + " ; " +
                          std::to_string(b[0]) + "," + std::to_string(b[1]),
                        zone,
                        of_points(a, b));
  };
  segment({0.35, 0.55}, {1.05, 0.55}, "everywhere");
  segment({0.35, 0.33}, {1.02, 0.93}, "everywhere");
  segment({0.35, 0.42}, {1.05, 0.61}, "0.4 - abs(y - 0.5)");
  std::string disc;
  for (unsigned int k = 0; k < 24; ++k)
    disc += (k > 0 ? " ; " : "") + std::to_string(0.4 + 0.23 * std::cos(0.2617993878 * k)) + "," +
            std::to_string(0.35 + 0.23 * std::sin(0.2617993878 * k)) + ",0.35";
  check_made_crack<3>("Polygons", disc, "everywhere", [](const Point<3> &p) {
    const double outside = std::hypot(p[0] - 0.4, p[1] - 0.35) - 0.23;
    return std::hypot(outside, p[2] - 0.35);
  });
  check_made_crack<3>("Polygons",
                      "0.15,0.15,0.25 ; 0.55,0.15,0.25 ; 0.55,0.55,0.25 ; 0.15,0.55,0.25",
                      "everywhere",
                      [](const Point<3> &p) {
                        const double outside =
                          std::max(std::abs(p[0] - 0.35) - 0.2, std::abs(p[1] - 0.35) - 0.2);
                        return std::hypot(outside, p[2] - 0.25);
                      });
}


namespace
{
  /**
   * Sum of the openings at the nodes beside a crack in a plane normal to the last axis.
   * @param inside whether a node is beside the crack
   */
  template <int dim>
  double opening(const Body<dim>                               &body,
                 const Vector                                  &u,
                 const double                                   level,
                 const std::function<bool(const Point<dim> &)> &inside)
  {
    double sum = 0.;
    for (unsigned int i = 0; i < body.nodes->n_owned(); ++i)
      {
        const double above = body.position(i)[dim - 1] - level;
        if (std::abs(above) < 0.06 && inside(body.position(i)))
          sum += std::copysign(1., above) * u.local_element(dim * i + dim - 1);
      }
    return sum_of_all(sum);
  }


  /** A crack made of broken bonds opens as the one of the scene, and a body without one less. */
  template <int dim>
  void check_openings(const std::string                             &entry,
                      const std::string                             &crack,
                      const double                                   level,
                      const std::function<bool(const Point<dim> &)> &inside,
                      const double                                   within = 5e-3)
  {
    const Settings pulled =
      breakable<dim>("everywhere", 0.3) +
      Settings{{"Boundary conditions/Displacement",
                dim == 2 ? "bottom: 0, 0; top: 0, 0.001" : "back: 0, 0, 0; front: 0, 0, 0.001"}};
    const Body<dim> given(pulled + Settings{{"Cracks/" + entry, crack}}, ModelKind::coupled);
    const Body<dim> made(pulled, ModelKind::coupled);
    const auto      across =
      pairs_of(given, [](const auto &bond, const auto &, const auto &) { return bond.cut; });
    ASSERT_FALSE(across.empty());
    const Vector whole = made.at_rest();
    made.elements->break_bonds(broken(across), whole, 0.);
    const double expected = opening(given, given.at_rest(), level, inside);
    EXPECT_GT(expected, 2. * opening(made, whole, level, inside)) << crack;
    EXPECT_NEAR(opening(made, made.at_rest(), level, inside), expected, within * expected) << crack;
  }
} // namespace


TEST(ZoneBreaking, crack_made_of_broken_bonds_opens_as_the_prescribed_one)
{
  const auto segment = [](const Point<2> &p) { return p[0] > 0.35 && p[0] < 1.05; };
  check_openings<2>("Segments", "0.35,0.55 ; 1.05,0.55", 0.55, segment);
  check_openings<3>(
    "Polygons",
    "0.15,0.15,0.25 ; 0.55,0.15,0.25 ; 0.55,0.55,0.25 ; 0.15,0.55,0.25",
    0.25,
    [](const Point<3> &p) { return std::max(std::abs(p[0] - 0.35), std::abs(p[1] - 0.35)) < 0.2; });
  check_openings<3>(
    "Polygons",
    "disc: 0.4, 0.35, 0.35, 0, 0, 1, 0.23",
    0.35,
    [](const Point<3> &p) { return std::hypot(p[0] - 0.4, p[1] - 0.35) < 0.23; },
    0.1); // all of its edge, 2.3 cells from the middle, is within cells
}


TEST_IN_DIMENSIONS(ZoneBreaking, follows_what_is_stretched, 1, 2, 3)
{
  const Settings finer{{"Domain/Cells", "28, 24"}, {"Domain/Upper corner", "1.4, 1.2"}};
  const std::vector<Settings> all = dim == 2 ? std::vector<Settings>{{}, finer} :
                                               std::vector<Settings>{{}};
  for (const Settings &more : all)
    {
      Body<dim> body(breakable<dim>("follow", 0.3) + more, ModelKind::coupled);
      check_following_zone(body, 0.02, 40., 0.9);
    }
}


namespace
{
  template <int dim>
  double found_stretch(const std::string &zone, const double strain)
  {
    const Body<dim> body(breakable<dim>(zone, 0.3), ModelKind::coupled);
    Vector          u = body.values(
      [strain](const Point<dim> &p) { return strain * p[0] * Point<dim>::unit_vector(0); });
    body.op().distribute(u, 0.);
    return body.op().stretch_over_critical(u, 0.);
  }


  /** A piece of the body that nothing holds, when the preconditioner is made. */
  template <int dim>
  void check_loose_piece(const double nu)
  {
    const Body<dim> body(
      breakable<dim>("everywhere", nu) +
        Settings{{"Boundary conditions/Displacement",
                  dim == 2 ? "bottom: 0, 0; top: 0, 0.001" : "back: 0, 0, 0; front: 0, 0, 0.001"}},
      ModelKind::coupled);
    const auto is_loose = [](const Point<dim> &p) {
      double farthest = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        farthest = std::max(farthest, std::abs(p[d] - 0.35));
      return farthest < 0.11;
    };
    const Vector whole = body.at_rest();
    body.elements->break_bonds(broken(pairs_of(body,
                                               [&](const auto &, const auto &a, const auto &b) {
                                                 return is_loose(a) != is_loose(b);
                                               })),
                               whole,
                               0.);
    const Vector u = body.at_rest();
    EXPECT_LT(body.residual(u).linfty_norm(), 1e-10);
    EXPECT_LT(body.op().energy(u), body.op().energy(whole));
  }
} // namespace


/** The critical stretch is 0.01. */
TEST_IN_DIMENSIONS(ZoneBreaking, knows_the_largest_stretch, 1, 2, 3)
{
  EXPECT_NEAR(found_stretch<dim>("everywhere", 0.004), 0.4, 1e-12);
  // Where bonds are to appear cells count, once they are stretched too far.
  EXPECT_EQ(found_stretch<dim>("follow", 0.004), 0.);
  EXPECT_NEAR(found_stretch<dim>("follow", 0.012), 1.2, 1e-12);
}


TEST(ZoneBreaking, solves_for_bodies_with_loose_pieces)
{
  for (const double nu : {0., 1. / 3., 0.45})
    check_loose_piece<2>(nu);
  check_loose_piece<3>(0.3);
}
