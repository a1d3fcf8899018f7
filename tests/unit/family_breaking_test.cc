// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Bonds that break in the families of a blending.

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>

#include "zone_breaking_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;
using dealii::Point;
using dealii::Tensor;

namespace
{
  template <int dim>
  Settings blended(const std::string &zone, const double nu)
  {
    return zoned<dim>(zone, nu) + Settings{{"Coupling/Scheme", "blending"},
                                           {"Material/Critical stretch", "0.01"},
                                           {"Elasticity/Contact", "false"}};
  }


  /** All bonds with a family in the zone for which choose(first place, second place) holds. */
  template <int dim, typename Choose>
  std::vector<NodePair> pairs_of(const Body<dim> &body, const Choose &choose)
  {
    std::vector<NodePair>                       own;
    std::vector<typename Families<dim>::Member> family;
    const Coupling<dim>                        &coupling = body.elements->bonds();
    const auto                                 &layout   = *body.nodes->partitioner();
    for (unsigned int i = 0; i < body.nodes->n_owned(); ++i)
      {
        coupling.families().members_of(i, family);
        for (const auto &member : family)
          {
            const unsigned int j = member.neighbor;
            const NodePair     pair{layout.local_to_global(i), layout.local_to_global(j)};
            if (pair[0] < pair[1] && (coupling.in_zone(i) || coupling.in_zone(j)) &&
                choose(body.position(i), body.position(j)))
              own.push_back(pair);
          }
      }
    return pairs_of_all(own);
  }


  /**
   * With families everywhere the operator of peridynamics, of which the same bonds have broken.
   */
  template <int dim>
  void expect_peridynamics(const Settings &more)
  {
    const Settings  settings = blended<dim>("everywhere", dim == 1 ? 0. : 0.4) + warm + more;
    const Body<dim> coupled(settings, ModelKind::coupled), alone(settings, ModelKind::peridynamics);
    const auto      field = [](const Point<dim> &p) {
      return Tensor<1, dim>(0.006 * bumpy_vector<dim>(p));
    };
    Vector     x       = coupled.values(field), y(x);
    Vector     x_alone = alone.values(field), y_alone(x_alone);
    const auto n       = coupled.op().break_bonds(x, 0., 0.3);
    EXPECT_EQ(n, alone.op().break_bonds(x_alone, 0., 0.3));
    EXPECT_GT(n, 0.02 * coupled.op().size().bonds);
    EXPECT_LT(n, 0.4 * coupled.op().size().bonds);
    const auto expect_same = [&](const std::string &what) {
      const double size = y.linfty_norm();
      for (unsigned int i = 0; i < y.locally_owned_size(); ++i)
        EXPECT_NEAR(y.local_element(i), y_alone.local_element(i), 1e-13 * size)
          << dim << "D: " << what;
    };
    coupled.op().multiply(y, x);
    alone.op().multiply(y_alone, x_alone);
    expect_same("K");
    coupled.op().unbalanced(y, x, 0.);
    alone.op().unbalanced(y_alone, x_alone, 0.);
    expect_same("forces");
    y       = coupled.op().diagonal();
    y_alone = alone.op().diagonal();
    expect_same("diagonal");
    EXPECT_NEAR(coupled.op().energy(x) / alone.op().energy(x_alone), 1., 1e-12);
    EXPECT_NEAR(coupled.op().released_energy() / alone.op().released_energy(), 1., 1e-11);
    const std::vector<double> a = coupled.elements->damage(), b = alone.states->breaking().damage();
    ASSERT_EQ(a.size(), b.size());
    for (unsigned int i = 0; i < a.size(); ++i)
      EXPECT_NEAR(a[i], b[i], 1e-12) << coupled.position(i);
    EXPECT_GE(coupled.op().spectrum().safe, 0.999 * alone.op().spectrum().sharp);
    EXPECT_NEAR(coupled.op().spectrum().sharp / alone.op().spectrum().sharp, 1., 0.02);
  }


  template <int dim>
  void check_a_fifth_broken(const std::string &zone, const double nu, const std::string &overlap)
  {
    Body<dim> body(blended<dim>(zone, nu) + warm + Settings{{"Coupling/Overlap", overlap}},
                   ModelKind::coupled);
    check_a_fifth_broken(body, pairs_of(body, is_chosen<dim>));
  }


  template <int dim>
  void check_following_zone(const Settings &more, const double largest_share)
  {
    Body<dim> body(blended<dim>("follow", 0.4) + more, ModelKind::coupled);
    check_following_zone(body, 0.002, 400., largest_share);
    check_sound(body);
  }
} // namespace


TEST(FamilyBreaking, everywhere_is_peridynamics)
{
  expect_peridynamics<1>({});
  expect_peridynamics<2>({});
  expect_peridynamics<2>({{"Cracks/Segments", "0.43, 0.55 ; 1.01, 0.75"}});
  expect_peridynamics<2>({{"Elasticity/Plane", "strain"},
                          {"Material/Phases/Regions", "stiff: x > 0.7"},
                          {"Material/Phases/Young modulus", "stiff: 30"}});
  expect_peridynamics<3>({});
}


TEST(FamilyBreaking, critical_stretch_is_that_of_peridynamics)
{
  const Settings settings =
    blended<2>("everywhere", 0.22) +
    Settings{{"Material/Critical stretch", ""}, {"Material/Fracture energy", "0.001 + 0.001*x"}};
  const Body<2> coupled(settings, ModelKind::coupled), alone(settings, ModelKind::peridynamics);
  const auto    field = [](const Point<2> &p) { return Tensor<1, 2>(0.01 * bumpy_vector<2>(p)); };
  const Vector  x = coupled.values(field), x_alone = alone.values(field);
  EXPECT_NEAR(coupled.op().stretch_over_critical(x) / alone.states->stretch_over_critical(x_alone),
              1.,
              1e-12);
}


TEST(FamilyBreaking, stays_sound_with_a_fifth_of_the_bonds_broken)
{
  for (const double nu : {-0.2, 0.3, 0.45})
    {
      check_a_fifth_broken<2>("everywhere", nu, "0");
      check_a_fifth_broken<2>("x - 0.55", nu, "1");
    }
  check_a_fifth_broken<3>("everywhere", 0.3, "0");
  check_a_fifth_broken<3>("x - 0.25", 0.45, "1");
}


TEST(FamilyBreaking, breaks_where_families_are_alone)
{
  const Body<2> body(blended<2>("x - 0.55", 0.3) + Settings{{"Coupling/Overlap", "1"}},
                     ModelKind::coupled);
  const Vector  u =
    body.values([](const Point<2> &p) { return 0.012 * p[0] * Point<2>::unit_vector(0); });
  EXPECT_GT(body.op().break_bonds(u, 0.), 0U);
  std::size_t known = 0;
  double      least = 2.;
  for (const NodePair &pair : body.op().broken_since(known))
    for (const auto node : pair)
      least = std::min(least, body.position(body.nodes->partitioner()->global_to_local(node))[0]);
  EXPECT_NEAR(dealii::Utilities::MPI::min(least, MPI_COMM_WORLD), 0.7, 1e-9);
  // So many cells are stretched too far in vain.
  EXPECT_EQ(body.op().stretched_outside(u).first, 7U * 12U);
  EXPECT_EQ(body.op().break_bonds(u, 0.), 0U);
}


TEST(FamilyBreaking, follows_what_is_stretched)
{
  check_following_zone<1>({{"Domain/Cells", "64"}}, 0.8);
  check_following_zone<2>({{"Domain/Cells", "28, 24"}, {"Domain/Upper corner", "1.4, 1.2"}}, 0.8);
  check_following_zone<2>({{"Domain/Cells", "28, 24"}, {"Coupling/Overlap", "1"}}, 0.9);
  check_following_zone<2>(warm + Settings{{"Domain/Cells", "28, 24"}}, 0.9);
  check_following_zone<3>({{"Domain/Upper corner", "1.2, 0.7, 0.6"}, {"Domain/Cells", "12, 7, 6"}},
                          1.1);
}
