// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// The parts of the state-based operator, each by itself.

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "elastic_test_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;

namespace
{
  using dealii::Point;
  using dealii::Tensor;

  const Settings completed{{"Peridynamics/Surface correction", "auto"}};
  const Settings full{{"Elasticity/Kinematics", "full"},
                      {"Elasticity/Solver", "conjugate gradients"}};


  /** Displacements with up-to-date ghosts. */
  template <int dim, typename Function>
  Vector local_values(const Body<dim> &body, const Function &f)
  {
    Vector u = body.values(f);
    u.update_ghost_values();
    return u;
  }


  /** Rows on a lattice, packed or not stored at all, have the bonds of others, and their sums. */
  template <int dim>
  void expect_same_rows(const Settings &more)
  {
    const auto body_of = [&](const char *form) {
      return Body<dim>(box<dim>() + more + Settings{{"Peridynamics/Operator form", form}},
                       ModelKind::peridynamics);
    };
    const Body<dim>       a = body_of("stored"), b = body_of("lattice");
    const BondTable<dim> &stored = a.states->bonds().rows, &lattice = b.states->bonds().rows;
    ASSERT_EQ(a.nodes->n_owned(), b.nodes->n_owned());
    const SolidSums<dim> &sums = a.states->bonds().sums, &of_lattice = b.states->bonds().sums;
    EXPECT_FALSE(sums.has_lattice());
    EXPECT_TRUE(of_lattice.has_lattice());
    EXPECT_EQ(sum_of_all(lattice.body.size()) > 0., !more.empty());
    EXPECT_LT(sum_of_all(lattice.body.size()), sum_of_all(stored.body.size()));
    EXPECT_DOUBLE_EQ(stored.n_bonds, 0.5 * stored.body.size());
    EXPECT_DOUBLE_EQ(stored.n_bonds, lattice.n_bonds);
    for (unsigned int i = 0; i < a.nodes->n_owned(); ++i)
      {
        std::vector<SolidBond<dim>> found;
        lattice.for_each(i, [&](const auto &bond) { found.push_back(bond); });
        std::size_t k = 0;
        stored.for_each(i, [&](const auto &bond) {
          ASSERT_LT(k, found.size());
          EXPECT_EQ(bond.neighbor, found[k].neighbor);
          EXPECT_NEAR((bond.moment - found[k].moment).norm(), 0., 1e-12 * bond.moment.norm());
          EXPECT_NEAR(bond.spring, found[k].spring, 1e-12 * bond.spring);
          ++k;
        });
        EXPECT_EQ(k, found.size());
      }
    const Vector u = local_values(a, bumpy_vector<dim>);
    Vector       y(u), z(u);
    Vector       tau(a.nodes->partitioner()), tau_of_lattice(tau);
    sums.find_tensions(tau.begin(), u.begin());
    of_lattice.find_tensions(tau_of_lattice.begin(), u.begin());
    tau.update_ghost_values();
    tau_of_lattice.update_ghost_values();
    for (const bool with_tau : {false, true})
      {
        sums.find_forces(y, u.begin(), with_tau ? tau.begin() : nullptr);
        of_lattice.find_tensions(tau_of_lattice.begin(), u.begin());
        of_lattice.find_forces(z, u.begin(), with_tau ? tau_of_lattice.begin() : nullptr);
        EXPECT_GT(y.linfty_norm(), 0.);
        EXPECT_LT(relative_difference(z, y), 1e-11);
      }
  }
} // namespace


TEST(SolidParts, rows_on_a_lattice_are_those_that_are_stored)
{
  expect_same_rows<2>({});
  expect_same_rows<3>({});
  // Bonds about the ends of a crack are cut in part.
  expect_same_rows<2>({{"Domain/Cells", "32, 24"}, {"Cracks/Segments", "0.4,0.4 ; 0.62,0.43"}});
  expect_same_rows<3>({{"Domain/Cells", "16, 12, 8"},
                       {"Cracks/Polygons", "0.4,0.3,-1 ; 0.6,0.32,-1 ; 0.6,0.32,2 ; 0.4,0.3,2"}});
}


TEST(SolidParts, laws_of_nodes)
{
  const Body<2>      body(box<2>() + Settings{{"Material/Young modulus", "if(x < 0.7, 3, 5)"}},
                     ModelKind::peridynamics);
  const NodeLaws<2> &laws = body.states->bonds().laws;
  EXPECT_TRUE(laws.volumetric);
  EXPECT_TRUE(laws.several_phases);
  unsigned int n_stiff = 0;
  for (unsigned int i = 0; i < body.nodes->n_owned(); ++i)
    {
      const double q = laws.weighted.local_element(i);
      EXPECT_GT(q, 0.);
      EXPECT_DOUBLE_EQ(laws.stiffness(i), laws[i].extension / q);
      EXPECT_DOUBLE_EQ(laws.tension(i, 2.) * q * q * body.nodes->volume(i),
                       2. * laws[i].volumetric * laws[i].dilatation);
      n_stiff += body.position(i)[0] < 0.7 ? 0 : 1;
    }
  // Most nodes are softer.
  const StateLaw soft =
    state_law(body.scene.material.moduli(Point<2>()), 2, body.scene.elasticity.plane);
  EXPECT_LT(sum_of_all(n_stiff), 0.5 * body.nodes->n_global());
  EXPECT_DOUBLE_EQ(laws.reference().extension, soft.extension);
  const Body<2> bonds(box<2>() + Settings{{"Elasticity/Model", "bond-based"},
                                          {"Material/Poisson ratio", "0.3333333333333333"}},
                      ModelKind::peridynamics);
  EXPECT_FALSE(bonds.states->bonds().laws.volumetric);
  EXPECT_FALSE(bonds.states->bonds().laws.several_phases);
}


TEST(SolidParts, thermal_strains)
{
  ThermalStrains strains;
  EXPECT_FALSE(strains.any());
  const unsigned int rank = this_process();
  // One process alone has some, and all know it.
  strains.set(
    3,
    [&](const unsigned int i) { return rank == 0 ? -0.1 * i : 0.; },
    MPI_COMM_WORLD);
  EXPECT_TRUE(strains.any());
  EXPECT_DOUBLE_EQ(strains[2], rank == 0 ? -0.2 : 0.);
  EXPECT_DOUBLE_EQ(strains.of_bond(1, 2), rank == 0 ? -0.15 : 0.);
  strains.set(
    3,
    [](const unsigned int) { return 0.; },
    MPI_COMM_WORLD);
  EXPECT_FALSE(strains.any());
}


TEST(SolidParts, rotations_stretch_bonds_of_linear_kinematics_alone)
{
  const auto turned = [](const Point<2> &p) {
    const double angle = 0.6;
    return Point<2>(std::cos(angle) * p[0] - std::sin(angle) * p[1],
                    std::sin(angle) * p[0] + std::cos(angle) * p[1]) -
           p;
  };
  for (const bool is_full : {true, false})
    {
      const Body<2>            body(box<2>() + (is_full ? full : Settings{}) +
                           Settings{{"Peridynamics/Operator form", "stored"}},
                         ModelKind::peridynamics);
      const BondKinematics<2> &kinematics = body.states->bonds().kinematics;
      const Vector             u          = local_values(body, turned);
      EXPECT_EQ(kinematics.is_full(), is_full);
      EXPECT_EQ(kinematics.is_strained(), is_full);
      double largest = 0., longest = 0.;
      for (unsigned int i = 0; i < body.nodes->n_owned(); ++i)
        body.states->bonds().rows.for_each(i, [&](const auto &bond) {
          largest = std::max(largest, std::abs(kinematics.extension_moment(u.begin(), i, bond)));
          longest = std::max(longest, bond.moment.norm());
        });
      if (is_full)
        {
          EXPECT_LT(largest, 1e-13 * longest);
          EXPECT_LT(body.states->bonds().forces.largest_stretch(u.begin()), 1e-13);
        }
      else
        EXPECT_GT(largest, 1e-3 * longest);
    }
}


// u_g = P u, and nodes get P^T of the forces on images: v . P^T f = f . P v.
TEST(SolidParts, images_pass_on_what_they_are_pulled_by)
{
  const Body<2> body(box<2>() + completed, ModelKind::peridynamics);
  ASSERT_TRUE(body.states->bonds().ends.images);
  const FictitiousImages<2> &images = *body.states->bonds().ends.images;
  const Vector               u      = local_values(body, bumpy_vector<2>);
  Vector                     y      = body.vector();
  images.find(u.begin());
  images.begin_forces();
  double product = 0.;
  for (unsigned int g = 0; g < images.size(); ++g)
    {
      const Tensor<1, 2> force = bumpy_vector<2>(images[g].place);
      images.pull(g, force);
      for (unsigned int d = 0; d < 2; ++d)
        product += force[d] * images.value(g)[d];
      // Constants are continued as such.
      Tensor<1, 2> sum;
      images.for_each_term(g, [&](const auto &term) {
        for (unsigned int d = 0; d < 2; ++d)
          sum[d] += term.of_component(d);
      });
      for (unsigned int d = 0; d < 2; ++d)
        EXPECT_NEAR(sum[d], 1., 1e-12);
    }
  images.pass_on(y);
  EXPECT_GT(sum_of_all(images.size()), 0.);
  EXPECT_NEAR(u * y, sum_of_all(product), 1e-11 * u.l2_norm() * y.l2_norm());
}


TEST(SolidParts, loads_and_what_is_near_to_them)
{
  const Body<2> body(box<2>() + Settings{{"Boundary conditions/Traction", "right: 2, 0; top: 0, 0"},
                                         {"Initial and source/Body force", "0, 3"}},
                     ModelKind::peridynamics);
  const SolidLoads<2>                                loads(body.states->bonds(), body.scene);
  std::map<dealii::types::boundary_id, Tensor<1, 2>> sums;
  loads.for_each(0., [&](const auto side, const unsigned int unknown, const double value) {
    sums[side][unknown % 2] += value;
  });
  EXPECT_NEAR(sum_of_all(sums[1][0]), 2. * 0.75, 1e-12);
  EXPECT_NEAR(sum_of_all(sums[dealii::numbers::internal_face_boundary_id][1]), 3. * 0.75, 1e-12);
  // A traction of zero loads nothing.
  const Families<2>              &families = body.states->bonds().families;
  const std::vector<unsigned int> nearby   = loads.sides_nearby(families);
  ASSERT_EQ(nearby.size(), body.nodes->n_local());
  for (unsigned int i = 0; i < body.nodes->n_owned(); ++i)
    {
      const double distance = 1. - body.position(i)[0];
      if (distance < 0.9 * body.scene.horizon())
        {
          EXPECT_EQ(nearby[i], 0u);
        }
      else if (distance > 1.5 * body.scene.horizon())
        {
          EXPECT_EQ(nearby[i], dealii::numbers::invalid_unsigned_int);
        }
    }
}


TEST(SolidParts, what_breaks_is_marked_and_bears_nothing)
{
  const Settings settings =
    box<2>() + Settings{{"Elasticity/Solver", "dynamics"}, {"Material/Critical stretch", "0.075"}};
  const Body<2> body(settings, ModelKind::peridynamics);
  const auto   &breaking = body.states->breaking();
  const auto   &rows     = body.states->bonds().rows;
  ASSERT_NE(breaking.history(), nullptr);
  EXPECT_EQ(rows.body.state.size(), rows.body.size());
  EXPECT_EQ(breaking.history()->n_broken, 0u);
  EXPECT_TRUE(breaking.history()->places.first.empty());
  const double n_bonds = sum_of_all(rows.n_bonds);
  const Vector u       = body.values([](const Point<2> &p) { return Point<2>(0.1 * p[0], 0.); });
  const auto   n       = body.op().break_bonds(u, 0.25);
  EXPECT_GT(n, 0u);
  EXPECT_EQ(breaking.history()->n_broken, n);
  EXPECT_EQ(breaking.history()->places.first.size(), 2u);
  EXPECT_DOUBLE_EQ(sum_of_all(rows.body.state.count(BondState::broken)), 2. * n);
  EXPECT_DOUBLE_EQ(sum_of_all(rows.n_bonds), n_bonds - n);
  for (unsigned int i = 0; i < body.nodes->n_owned(); ++i)
    rows.for_each(i, [&](const auto &bond) {
      const bool is_whole = rows.body.state.is_whole(bond.number);
      EXPECT_EQ(bond.spring != 0., is_whole);
      EXPECT_EQ(bond.moment.norm() != 0., is_whole);
      EXPECT_EQ(rows.body.state.since(bond.number),
                is_whole ? std::numeric_limits<double>::infinity() : 0.25);
    });
  const Body<2> whole(box<2>(), ModelKind::peridynamics);
  EXPECT_EQ(whole.states->breaking().history(), nullptr);
  EXPECT_FALSE(whole.op().brittle());
  EXPECT_EQ(whole.op().n_broken_bonds(), 0u);
  EXPECT_TRUE(whole.op().break_places().first.empty());
  EXPECT_TRUE(whole.states->breaking().critical_stretches().empty());
}
