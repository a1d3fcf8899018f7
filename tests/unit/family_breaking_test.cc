// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Bonds that break in the families of a blending.

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <sstream>

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


  const Settings nodal{{"Elasticity/Model", "correspondence"},
                       {"Peridynamics/Horizon ratio", "2"},
                       {"Peridynamics/Kernel exponent", "auto"},
                       {"Peridynamics/Operator form", "stored"}};


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


  template <int dim>
  Vector stretched(const Body<dim> &body)
  {
    return body.values(
      [](const Point<dim> &p) { return Tensor<1, dim>(0.006 * bumpy_vector<dim>(p)); });
  }


  /** A body whose families are everywhere, and peridynamics: forces, energies, damage. */
  template <int dim>
  void expect_same_bodies(const Body<dim> &coupled, const Body<dim> &alone)
  {
    const Vector x = stretched(coupled), x_alone = stretched(alone);
    const auto   expect_same = [&](const std::string &what, const Vector &y, const Vector &z) {
      EXPECT_LE(largest_difference(y, z), 1e-13 * y.linfty_norm()) << dim << "D: " << what;
    };
    expect_same("K", coupled.product(x), alone.product(x_alone));
    expect_same("forces", coupled.unbalanced(x), alone.unbalanced(x_alone));
    if (!coupled.scene.elasticity.is_correspondence()) // it is that of the ordinary solid
      expect_same("diagonal", coupled.op().diagonal(), alone.op().diagonal());
    EXPECT_NEAR(coupled.op().energy(x) / alone.op().energy(x_alone), 1., 1e-12);
    EXPECT_NEAR(coupled.op().released_energy() / alone.op().released_energy(), 1., 1e-11);
    const std::vector<double> a = coupled.elements->beside().breaking->damage(),
                              b = alone.states->breaking().damage();
    ASSERT_EQ(a.size(), b.size());
    for (unsigned int i = 0; i < a.size(); ++i)
      EXPECT_NEAR(a[i], b[i], 1e-12) << coupled.position(i);
    EXPECT_GE(coupled.op().spectrum().safe, 0.999 * alone.op().spectrum().sharp);
    EXPECT_NEAR(coupled.op().spectrum().sharp / alone.op().spectrum().sharp, 1., 0.02);
  }


  /**
   * With families everywhere the operator of peridynamics, of which the same bonds have broken.
   */
  template <int dim>
  void expect_peridynamics(const Settings &more)
  {
    const Settings  settings = blended<dim>("everywhere", dim == 1 ? 0. : 0.4) + warm + more;
    const Body<dim> coupled(settings, ModelKind::coupled), alone(settings, ModelKind::peridynamics);
    const auto      n = coupled.op().break_bonds(stretched(coupled), 0., 0.3);
    EXPECT_EQ(n, alone.op().break_bonds(stretched(alone), 0., 0.3));
    EXPECT_GT(n, 0.02 * coupled.op().size().bonds);
    EXPECT_LT(n, 0.4 * coupled.op().size().bonds);
    expect_same_bodies(coupled, alone);
  }


  /** Of a crack that grows, all events; bonds break before, midway and at last. */
  template <int dim>
  void grow_and_break(const Body<dim> &body, const Vector &u, const double share)
  {
    ElasticOperator &op       = body.op();
    const double     energy   = op.energy(u);
    unsigned int     n_events = 0;
    const auto       advance  = [&](const double at_least) {
      while (op.widen_zone(u))
        ;
      return op.break_bonds(u, 0., at_least);
    };
    EXPECT_GT(advance(share), 0U);
    for (double t = op.next_event(0.); t < 1.; t = op.next_event(t), ++n_events)
      {
        EXPECT_TRUE(op.grow_cracks(u, t));
        if (t > 0.3 && t < 0.35)
          op.break_bonds(u, t, 0.8 * share);
      }
    EXPECT_GT(n_events, 5U);
    advance(0.);
    // Whatever is cut, breaks or joins is counted.
    EXPECT_NEAR(op.energy(u) + op.released_energy(), energy, 1e-12 * energy);
    EXPECT_GT(std::abs(op.released_energy()), 1e-3 * energy);
  }


  template <int dim>
  struct Crack
  {
    Settings growing, grown; // that it grows, and as it is at last
  };


  /** From one wall of a row of cells to another one. */
  template <int dim>
  Crack<dim> crack_at(const double from, const double start, const double end, const double level)
  {
    const auto segment = [&](const double last) {
      std::ostringstream text;
      if (dim == 2)
        text << from << ',' << level << " ; " << last << ',' << level;
      else
        text << from << ",0.05," << level << " ; " << last << ",0.05," << level << " ; " << last
             << ",0.45," << level << " ; " << from << ",0.45," << level;
      return Settings{{dim == 2 ? "Cracks/Segments" : "Cracks/Polygons", text.str()}};
    };
    std::ostringstream growth; // from t = 0.1 to 0.6
    growth << "2: 0.1, " << 2. * (end - start) << (dim == 2 ? ",0, 0.6" : ",0,0, 0.6");
    if (dim == 3)
      growth << " ; 3: 0.1, " << 2. * (end - start) << ",0,0, 0.6";
    return {segment(start) + Settings{{"Cracks/Growth", growth.str()}, {"Time/End time", "1"}},
            segment(end)};
  }


  template <int dim>
  void expect_peridynamics_with_growth(const Settings &more, const Crack<dim> &crack)
  {
    const Settings  settings = blended<dim>("everywhere", 0.4) + more + crack.growing;
    const Body<dim> coupled(settings, ModelKind::coupled), alone(settings, ModelKind::peridynamics);
    grow_and_break(coupled, stretched(coupled), 0.4);
    grow_and_break(alone, stretched(alone), 0.4);
    EXPECT_EQ(coupled.op().n_broken_bonds(), alone.op().n_broken_bonds());
    expect_same_bodies(coupled, alone);
  }


  /** A crack that grows through what breaks, beside elements: at last as if it had been there. */
  template <int dim>
  void expect_grown(const Settings &more, const Crack<dim> &crack, const double sharpness)
  {
    const Settings  settings = blended<dim>(dim == 2 ? "0.7 - y" : "1.4 - x", 0.3) + more;
    const Body<dim> body(settings + crack.growing, ModelKind::coupled),
      built(settings + crack.grown, ModelKind::coupled);
    const Vector u = peak(body, 0.012, sharpness), v = peak(built, 0.012, sharpness);
    const Vector before = body.unbalanced(u);
    grow_and_break(body, u, 0.3);
    const auto n = built.op().break_bonds(v, 0.);
    EXPECT_GT(n, 10U);
    EXPECT_GT(body.op().n_broken_bonds(), n); // also what the crack has cut after it broke
    const Vector y = body.unbalanced(u), z = built.unbalanced(v);
    EXPECT_GT(largest_difference(before, y), 1e-3 * z.linfty_norm());
    EXPECT_LE(relative_difference(y, z), 1e-12);
    EXPECT_NEAR(body.op().energy(u) / built.op().energy(v), 1., 1e-12);
    EXPECT_LE(relative_difference(body.op().diagonal(), built.op().diagonal()), 1e-12);
    check_sound(body);
  }


  template <int dim>
  void check_a_fifth_broken(const std::string &zone,
                            const double       nu,
                            const std::string &overlap,
                            const Settings    &more = {})
  {
    Body<dim> body(blended<dim>(zone, nu) + warm + Settings{{"Coupling/Overlap", overlap}} + more,
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


  /** Nodes around which there are families alone, or elements alone. */
  template <int dim>
  bool is_amid(const Body<dim> &body, const unsigned int node, const bool families)
  {
    const Coupling<dim> &bonds = body.elements->bonds();
    const auto          &nodes = bonds.families().nodes();
    const double around = bonds.families().weights().horizon() + 1.01 * nodes.lattice()->spacing[0];
    for (unsigned int j = 0; j < nodes.n_local(); ++j)
      if (nodes.position(j).distance(nodes.position(node)) < around && bonds.in_zone(j) != families)
        return false;
    return true;
  }


  /**
   * Of K of a zone that follows what is stretched and, if there is one, a crack that grows: rows of
   * families everywhere and of elements, whose cracks are as they are at last.
   */
  template <int dim>
  void check_rows_of_following_zone(const Settings   &more,
                                    const double      height,
                                    const double      sharpness,
                                    const double      largest_share,
                                    const Crack<dim> &crack = {})
  {
    const Settings  follow = blended<dim>("follow", 0.4) + more;
    const Body<dim> body(follow + crack.growing, ModelKind::coupled),
      full(follow + Settings{{"Coupling/Zone", "everywhere"}} + crack.grown,
           ModelKind::coupled,
           MPI_COMM_SELF),
      elements(zoned<dim>("cracks: 1", 0.4) + more + crack.grown,
               ModelKind::finite_elements,
               MPI_COMM_SELF);
    const Vector u = peak(body, height, sharpness);
    if (crack.grown.empty())
      {
        ASSERT_TRUE(body.op().widen_zone(u));
        body.op().break_bonds(u, 0.);
      }
    else
      grow_and_break(body, u, 0.3);
    const auto n = full.op().break_bonds(peak(full, height, sharpness), 0.);
    EXPECT_GT(n, 10U);
    if (crack.grown.empty())
      EXPECT_EQ(body.op().n_broken_bonds(), n);
    else
      EXPECT_GT(body.op().n_broken_bonds(), n); // and what has been cut after it broke
    EXPECT_LT(body.elements->bonds().zone_share(), largest_share);
    const Vector y = body.product(body.values(bumpy_vector<dim>));
    for (const Body<dim> *other : {&full, &elements})
      {
        const Vector z          = other->product(other->values(bumpy_vector<dim>));
        unsigned int n_compared = 0;
        for_each_pair(body, *other, [&](const unsigned int i, const unsigned int k) {
          if (is_amid(body, i, other == &full))
            {
              for (unsigned int d = 0; d < dim; ++d, ++n_compared)
                EXPECT_NEAR(y.local_element(dim * i + d),
                            z.local_element(dim * k + d),
                            1e-13 * z.linfty_norm())
                  << body.position(i);
            }
        });
        EXPECT_GT(sum_of_all(n_compared), 0.05 * y.size());
      }
    check_sound(body);
  }


  /** Temperatures that are set on the way in a zone that follows, and the last one, given. */
  template <int dim>
  void check_temperatures(const Settings &more)
  {
    const Settings settings =
      blended<dim>("follow", 0.4) + more + Settings{{"Material/Thermal expansion", "1e-3"}};
    const Body<dim> given(settings + Settings{{"Elasticity/Temperature change", "-1 - x"}},
                          ModelKind::coupled),
      set(settings, ModelKind::coupled);
    const Vector u = peak(set, 0.002, 400.), v = peak(given, 0.002, 400.);
    const auto   cool = [&](const double by) {
      Vector change(set.nodes->partitioner());
      for (unsigned int i = 0; i < set.nodes->n_owned(); ++i)
        change.local_element(i) = by - set.position(i)[0];
      set.op().set_temperature_change(change);
    };
    const auto follow = [](const Body<dim> &body, const Vector &at) {
      while (body.op().widen_zone(at))
        ;
      return body.op().break_bonds(at, 0.);
    };
    cool(1.5);
    const auto n_first = follow(set, u);
    cool(-1.);
    const double before = set.op().energy(u);
    const double told   = set.op().released_energy();
    const auto   n_last = follow(set, u), n = follow(given, v);
    EXPECT_GT(n_first, 0U);
    EXPECT_GT(n_last, 0U); // cold bonds are stretched farther
    EXPECT_EQ(n_first + n_last, n);
    EXPECT_NEAR(before - set.op().energy(u), set.op().released_energy() - told, 1e-12 * before);
    EXPECT_LT(given.elements->bonds().zone_share(), 0.9);
    EXPECT_EQ(given.op().size().bonds, set.op().size().bonds);
    EXPECT_LE(relative_difference(set.unbalanced(u), given.unbalanced(v)), 1e-12);
    EXPECT_NEAR(set.op().energy(u) / given.op().energy(v), 1., 1e-12);
  }


  const Settings wide{{"Domain/Cells", "28, 24"}, {"Domain/Upper corner", "1.4, 1.2"}};
  const Settings beam{{"Domain/Upper corner", "2, 0.5, 0.4"}, {"Domain/Cells", "20, 5, 4"}};
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
  // Alone, warm nodes keep an energy when they have lost their hold.
  const Settings cold = nodal + Settings{{"Elasticity/Temperature change", "0"}};
  expect_peridynamics<2>(cold + Settings{{"Cracks/Segments", "0.43, 0.55 ; 1.01, 0.75"}});
  expect_peridynamics<2>(cold + Settings{{"Elasticity/Plane", "strain"}});
  expect_peridynamics<3>(cold);
}


TEST(FamilyBreaking, critical_stretch_is_that_of_peridynamics)
{
  const Settings settings =
    blended<2>("everywhere", 0.22) +
    Settings{{"Material/Critical stretch", ""}, {"Material/Fracture energy", "0.001 + 0.001*x"}};
  const Body<2> coupled(settings, ModelKind::coupled), alone(settings, ModelKind::peridynamics);
  const auto    field = [](const Point<2> &p) { return Tensor<1, 2>(0.01 * bumpy_vector<2>(p)); };
  const Vector  x = coupled.values(field), x_alone = alone.values(field);
  EXPECT_NEAR(coupled.op().stretch_over_critical(x, 0.) /
                alone.states->stretch_over_critical(x_alone, 0.),
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
  check_a_fifth_broken<2>("x - 0.55", 0.3, "1", nodal);
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
  check_following_zone<2>(nodal + wide, 0.9);
  check_following_zone<3>(beam, 0.4); // measured: 0.323
}


TEST(FamilyBreaking, leaves_elements_where_nothing_is_stretched)
{
  check_rows_of_following_zone<2>(wide, 0.004, 200., 0.21); // measured: 0.173
  check_rows_of_following_zone<3>(beam, 0.004, 50., 0.5);   // 0.433
}


TEST(FamilyBreaking, grown_cracks_and_broken_bonds_are_those_of_peridynamics)
{
  expect_peridynamics_with_growth<2>({}, crack_at<2>(0.35, 0.65, 0.95, 0.55));
  expect_peridynamics_with_growth<2>(warm, crack_at<2>(0.35, 0.65, 0.95, 0.55));
  expect_peridynamics_with_growth<3>({}, crack_at<3>(0.15, 0.35, 0.55, 0.25));
}


TEST(FamilyBreaking, cracks_grow_through_what_breaks)
{
  const Crack<2> level = crack_at<2>(0.2, 0.35, 0.7, 0.075);
  const Crack<3> plane = crack_at<3>(0.2, 0.35, 0.75, 0.15);
  for (const char *overlap : {"0", "1"})
    expect_grown<2>(wide + Settings{{"Coupling/Overlap", overlap}}, level, 200.);
  expect_grown<2>(wide + nodal, level, 200.);
  expect_grown<3>(beam, plane, 50.);
  check_rows_of_following_zone<2>(wide, 0.012, 200., 0.27, level); // measured: 0.224
  check_rows_of_following_zone<3>(beam, 0.012, 50., 0.65, plane);  // 0.569
}


TEST(FamilyBreaking, follows_temperatures_that_change)
{
  check_temperatures<2>(wide);
  check_temperatures<2>(wide + Settings{{"Coupling/Overlap", "1"}});
  check_temperatures<2>(wide + nodal);
  check_temperatures<3>(beam);
}
