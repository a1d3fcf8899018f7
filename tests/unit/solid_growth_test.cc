// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Elastic bodies whose cracks grow: at last they are those whose cracks have been so long from the
// start.

#include <deal.II/base/mpi.h>

#include <perideal/mesh/node_keys.h>

#include "distorted_mesh.h"
#include "elastic_test_tools.h"
#include "scene_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using namespace SceneTests;

  namespace
  {
    // Which nodes touch depends on what was before.
    const Settings open{{"Elasticity/Contact", "false"}};
    const Settings start{{"Cracks/Segments", "0.3,0.36 ; 0.45,0.38"}};
    const Settings growing =
      start + Settings{{"Cracks/Growth", "2: 0.1, 0.45,0.06, 0.6"}, {"Time/End time", "1"}};
    const Settings grown{{"Cracks/Segments", "0.3,0.36 ; 0.675,0.41"}};
    const Settings square{
      {"Cracks/Polygons", "0.2,0.2,0.26 ; 0.5,0.2,0.26 ; 0.5,0.5,0.26 ; 0.2,0.5,0.26"}};
    const Settings growing_square =
      square + Settings{{"Cracks/Growth", "2: 0.1, 0.4,0,0, 0.6 ; 3: 0.1, 0.4,0,0, 0.6"},
                        {"Time/End time", "1"}};
    const Settings grown_square{
      {"Cracks/Polygons", "0.2,0.2,0.26 ; 0.7,0.2,0.26 ; 0.7,0.5,0.26 ; 0.2,0.5,0.26"}};
    const Settings centers{{"Domain/Nodes", "cell centers"}};
    const Settings vertices{{"Domain/Nodes", "vertices"}};
    const Settings full{{"Elasticity/Kinematics", "full"},
                        {"Elasticity/Solver", "conjugate gradients"}};
    const Settings warm{{"Material/Thermal expansion", "0.1"},
                        {"Elasticity/Temperature change", "1 + x"}};


    /** Through all events; no energy is lost on the way. */
    template <int dim>
    void grow(const Body<dim> &body, const Vector &u)
    {
      ElasticOperator &op     = body.op();
      const double     before = op.energy(u), released = op.released_energy();
      unsigned int     n_changes = 0;
      EXPECT_FALSE(op.grow_cracks(u, 0.));
      for (double t = op.next_event(0.); t < 1.; t = op.next_event(t))
        n_changes += op.grow_cracks(u, t);
      EXPECT_GT(n_changes, 5u);
      EXPECT_FALSE(op.grow_cracks(u, 1.));
      EXPECT_NE(op.released_energy(), released);
      EXPECT_NEAR(op.energy(u) + op.released_energy(), before + released, 1e-12 * before);
    }


    /** Forces, loads and the diagonal of two bodies with the same nodes. */
    template <int dim>
    void expect_equal(const Body<dim> &a, const Body<dim> &b, const double tolerance)
    {
      const Vector u = a.values(bumpy_vector<dim>), of_b = b.product(u);
      const double size = of_b.linfty_norm();
      EXPECT_LE(relative_difference(a.op().diagonal(), b.op().diagonal()), tolerance);
      EXPECT_LE(relative_difference(a.product(u), of_b), tolerance);
      EXPECT_LE(largest_difference(a.unbalanced(u), b.unbalanced(u)), tolerance * size);
      EXPECT_NEAR(a.op().energy(u), b.op().energy(u), tolerance * b.op().energy(u));
      EXPECT_EQ(a.op().size().bonds, b.op().size().bonds);
      if (!a.op().nonlinear())
        return;
      for (const Body<dim> *body : {&a, &b})
        body->op().linearize(u);
      EXPECT_LE(largest_difference(a.product(u), b.product(u)), tolerance * size);
      for (const Body<dim> *body : {&a, &b})
        body->op().linearize(body->vector());
    }


    template <int dim>
    void expect_grown(const std::string &what, const Settings &settings, const ModelKind model)
    {
      SCOPED_TRACE(what + ", " + std::to_string(dim) + "D, " + to_string(model));
      constexpr double tolerance = 1e-12;
      const Settings   base      = box<dim>() + settings + open;
      const Body<dim>  body(base + (dim == 3 ? growing_square : growing), model),
        whole(base + (dim == 3 ? square : start), model),
        built(base + (dim == 3 ? grown_square : grown), model);
      const Vector u = body.values(bumpy_vector<dim>);
      // The mesh is shared out by what cells have to do at last: nodes may lie elsewhere.
      EXPECT_NEAR(body.op().energy(u),
                  whole.op().energy(whole.values(bumpy_vector<dim>)),
                  tolerance * body.op().energy(u));
      EXPECT_EQ(body.op().size().bonds, whole.op().size().bonds);
      if (model != ModelKind::coupled)
        expect_equal(body, whole, tolerance);
      const auto n_bonds = body.op().size().bonds;
      grow(body, u);
      expect_equal(body, built, tolerance);
      if (!body.op().zone_follows_cracks())
        EXPECT_EQ(body.op().released().by_joining, 0.);
      else
        {
          EXPECT_NE(body.op().released().by_joining, 0.);
          EXPECT_GT(body.op().size().bonds, n_bonds); // but for those that are cut
        }
    }
  } // namespace


  TEST(SolidGrowth, peridynamics)
  {
    constexpr auto bonds = ModelKind::peridynamics;
    for (const Settings &nodes : {centers, vertices})
      {
        expect_grown<2>("lattice", nodes, bonds);
        expect_grown<2>("stored",
                        nodes + Settings{{"Peridynamics/Operator form", "stored"}},
                        bonds);
        expect_grown<2>("warm", nodes + warm, bonds);
        expect_grown<2>("full kinematics", nodes + full, bonds);
        for (const char *m : {"2", "3.015", "4"})
          expect_grown<2>("m", nodes + Settings{{"Peridynamics/Horizon ratio", m}}, bonds);
        expect_grown<3>("block", nodes, bonds);
      }
    expect_grown<2>("bond-based", {{"Elasticity/Model", "bond-based"}}, bonds);
    expect_grown<2>("constant micromodulus",
                    {{"Elasticity/Model", "bond-based"}, {"Elasticity/Micromodulus", "constant"}},
                    bonds);
  }


  TEST(SolidGrowth, beside_planes_of_symmetry)
  {
    // The cracks come within a horizon of the plane, or cross it: mirrored bonds are cut, too.
    const Settings    mirror{{"Boundary conditions/Displacement", "right: 0, 0"},
                          {"Boundary conditions/Symmetry", "bottom"},
                          {"Time/End time", "1"}};
    const char *const cracks[][3] = {
      {"0.31,0.13 ; 0.41,0.15", "2: 0, 0.5,0.1, 0.5", "0.31,0.13 ; 0.66,0.2"},
      {"0.31,-0.1 ; 0.33,0.1", "2: 0, 0.02,0.2, 0.5", "0.31,-0.1 ; 0.34,0.2"}};
    for (const Settings &nodes : {centers, vertices})
      for (const Settings &more : {Settings(), full})
        for (const auto &crack : cracks)
          {
            const Settings base = box<2>() + mirror + nodes + more + open;
            const Body<2>  body(
              base + Settings{{"Cracks/Segments", crack[0]}, {"Cracks/Growth", crack[1]}},
              ModelKind::peridynamics),
              built(base + Settings{{"Cracks/Segments", crack[2]}}, ModelKind::peridynamics);
            grow(body, body.values(bumpy_vector<2>));
            expect_equal(body, built, 1e-12);
          }
  }


  TEST(SolidGrowth, finite_elements)
  {
    for (const Settings &more : {Settings(), warm})
      expect_grown<2>("elements", more, ModelKind::finite_elements);
    expect_grown<3>("elements", {}, ModelKind::finite_elements);
  }


  TEST(SolidGrowth, coupled)
  {
    const Settings zone{{"Coupling/Zone", "cracks: 1"}};
    const Settings overlap{{"Coupling/Overlap", "1"}};
    for (const Settings &more : {Settings(), warm})
      {
        expect_grown<2>("exchange", zone + more, ModelKind::coupled);
        for (const char *scheme : {"blending", "splice"})
          expect_grown<2>(scheme,
                          zone + more + overlap + Settings{{"Coupling/Scheme", scheme}},
                          ModelKind::coupled);
      }
    expect_grown<2>("crack scaling",
                    zone + Settings{{"Peridynamics/Surface correction", "crack scaling"}},
                    ModelKind::coupled);
    expect_grown<3>("exchange", zone, ModelKind::coupled);
  }


  TEST(SolidGrowth, in_a_linear_field_joining_releases_nothing)
  {
    // With two horizons no bond that joins reaches back to what the crack has cut before.
    const Settings zone{{"Coupling/Zone", "cracks: 2"}, {"Peridynamics/Horizon ratio", "2"}};
    const auto     check = [](const auto &body) {
      const Vector u      = body.values([](auto p) {
        p *= 0.3;
        p[0] += 0.7 * p[1];
        return p;
      });
      const double before = body.op().energy(u);
      grow(body, u);
      EXPECT_NEAR(body.op().released().by_joining, 0., 1e-12 * before);
      EXPECT_GT(body.op().released().by_growth, 1e-3 * before);
    };
    check(Body<2>(box<2>() + zone + open + growing, ModelKind::coupled));
    check(Body<3>(box<3>() + zone + open + growing_square, ModelKind::coupled));
  }


  TEST(SolidGrowth, coupled_on_a_distorted_mesh)
  {
    const Settings mesh{{"Domain/Shape", "mesh file"},
                        {"Domain/Mesh file", distorted_mesh<2>(20, 0.25)},
                        {"Peridynamics/Horizon", "0.15"},
                        {"Material/Young modulus", "3"},
                        {"Material/Poisson ratio", "0.2"},
                        {"Boundary conditions/Displacement", "0: 0, 0"},
                        {"Cracks/Growth step", "0.0125"}};
    for (const char *const zone : {"cracks: 1", "cracks: 0.4"})
      for (const Settings &more : {Settings(), warm})
        {
          const Settings base = mesh + more + open + Settings{{"Coupling/Zone", zone}};
          const Body<2>  body(base + growing, ModelKind::coupled),
            built(base + grown, ModelKind::coupled);
          const auto n_bonds = body.op().size().bonds;
          grow(body, body.values(bumpy_vector<2>));
          expect_equal(body, built, 1e-12);
          EXPECT_NE(body.op().released().by_joining, 0.);
          EXPECT_GT(body.op().size().bonds, n_bonds);
        }
  }


  TEST(SolidGrowth, beside_bonds_that_break)
  {
    const Settings brittle{{"Material/Critical stretch", "0.5"}};
    for (const Settings &more : {Settings(), full, warm})
      {
        const Body<2> body(box<2>() + growing + brittle + more, ModelKind::peridynamics),
          alone(box<2>() + growing + brittle + more, ModelKind::peridynamics, MPI_COMM_SELF);
        double released[2], damage[2];
        for (unsigned int k = 0; k < 2; ++k)
          {
            const Body<2>   &b  = k == 0 ? body : alone;
            ElasticOperator &op = b.op();
            const Vector     u =
              b.values([](const dealii::Point<2> &p) { return 0.2 * bumpy_vector(p); });
            const double before = op.energy(u);
            op.grow_cracks(u, 0.3);
            EXPECT_GT(op.break_bonds(u, 0.3), 100u);
            op.grow_cracks(u, 0.9);
            EXPECT_EQ(op.break_bonds(u, 0.9), 0u); // what is cut does not break
            EXPECT_NEAR(op.energy(u) + op.released_energy(), before, 1e-12 * before);
            released[k] = op.released_energy();
            damage[k]   = 0.;
            for (const double d : b.states->breaking().damage())
              {
                EXPECT_GE(d, 0.);
                EXPECT_LE(d, 1.);
                damage[k] += d;
              }
          }
        EXPECT_NEAR(released[0], released[1], 1e-11 * std::abs(released[1]));
        EXPECT_NEAR(sum_of_all(damage[0]), damage[1], 1e-11 * damage[1]);
      }
  }


  TEST(SolidGrowth, damage_is_that_of_the_crack_from_the_start)
  {
    for (const Settings &nodes : {centers, vertices})
      {
        const Body<2> body(box<2>() + nodes + open + growing, ModelKind::peridynamics),
          built(box<2>() + nodes + open + grown, ModelKind::peridynamics);
        grow(body, body.values(bumpy_vector<2>));
        const std::vector<double> a = body.states->breaking().damage(),
                                  b = built.states->breaking().damage();
        ASSERT_EQ(a.size(), b.size());
        double most = 0.;
        for (std::size_t i = 0; i < a.size(); ++i)
          {
            EXPECT_NEAR(a[i], b[i], 1e-14);
            most = std::max(most, a[i]);
          }
        EXPECT_GT(max_of_all(most), 0.2);
      }
  }


  TEST(SolidGrowth, a_node_without_hold_is_told)
  {
    // Around the node at (0.40625, 0.40625): cracks above and beside it grow until it is cut off.
    const Settings base =
      box<2>() + centers +
      Settings{{"Peridynamics/Horizon ratio", "2"},
               {"Cracks/Segments",
                "0.366,0.436 ; 0.42,0.436 ; 0.366,0.376 ; 0.5,0.376 ; 0.366,0.37 ; 0.366,0.44 ; "
                "0.446,0.2 ; 0.446,0.3"},
               {"Cracks/Growth", "2: 0, 0.1,0 ; 8: 0, 0,0.3"},
               {"Time/End time", "0.7"}};
    const Body<2> body(base, ModelKind::peridynamics);
    const Vector  u = body.values(bumpy_vector<2>);
    expect_error(
      [&] { body.op().grow_cracks(u, 0.6); },
      {"With the cracks as they are from t = ", "The node at (0.40625, 0.40625)", "bond"});
  }
} // namespace PeriDeal
