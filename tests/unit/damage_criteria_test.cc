// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// When bonds break, other than at one stretch: limits that change, energies, stresses, never.

#include <perideal/base/user_error.h>
#include <perideal/operators/solid/bond_energies.h>
#include <perideal/operators/solid/solid_tensors.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "dimensions.h"
#include "elastic_test_tools.h"
#include "scene_test_tools.h"

namespace PeriDeal
{
  using namespace OperatorTests;
  using namespace SceneTests;
  using dealii::Point;
  using dealii::Tensor;

  namespace
  {
    const Settings moves{{"Elasticity/Solver", "dynamics"}};

    const char *const models[] = {"state-based", "bond-based", "correspondence"};


    /** u = s x: all bonds are stretched by s. */
    template <int dim>
    Vector grown(const Body<dim> &body, const double s)
    {
      return body.values([s](const Point<dim> &p) { return Tensor<1, dim>(s * p); });
    }


    /** Bonds of a body that each process has whole, of which a condition is true, each once. */
    template <int dim>
    unsigned long long count(
      const Settings                                                           &settings,
      const std::function<bool(const Point<dim> &p, const Tensor<1, dim> &xi)> &counts)
    {
      const Body<dim>    alone(settings, ModelKind::peridynamics, MPI_COMM_SELF);
      unsigned long long n = 0;
      std::vector<typename Families<dim>::Member> family;
      for (unsigned int i = 0; i < alone.nodes->n_owned(); ++i)
        {
          alone.states->bonds().families.members_of(i, family);
          for (const auto &bond : family)
            n += bond.neighbor != i &&
                 counts(alone.position(i), alone.position(bond.neighbor) - alone.position(i));
        }
      return n / 2;
    }


    /** How many bonds break at u and t, alike in all models and forms of the operator. */
    template <int dim>
    void expect_breaks(const Settings                                     &settings,
                       const std::function<Vector(const Body<dim> &body)> &u,
                       const double                                        t,
                       const unsigned long long                            expected)
    {
      for (const char *model : models)
        for (const char *kinematics : {"linear", "full"})
          {
            const bool is_nodal = std::string(model) == "correspondence";
            if (is_nodal && (dim == 1 || std::string(kinematics) == "full"))
              continue;
            SCOPED_TRACE(std::string(model) + ", " + kinematics);
            const Body<dim> body(
              settings + moves +
                Settings{{"Elasticity/Model", model}, {"Elasticity/Kinematics", kinematics}},
              ModelKind::peridynamics);
            ElasticOperator &op     = body.op();
            const Vector     at     = u(body);
            const double     before = op.energy(at);
            EXPECT_EQ(op.break_bonds(at, t), expected);
            EXPECT_EQ(op.break_bonds(at, t), 0u);
            EXPECT_EQ(op.n_broken_bonds(), expected);
            // What breaks of families without bonds takes forces of the rest along.
            if (!is_nodal)
              {
                EXPECT_NEAR(op.energy(at) + op.released_energy(), before, 1e-12 * before);
              }
          }
      const Body<dim> lattice(settings + moves +
                                Settings{{"Peridynamics/Operator form", "lattice"}},
                              ModelKind::peridynamics);
      EXPECT_EQ(lattice.op().break_bonds(u(lattice), t), expected);
    }
  } // namespace


  TEST_IN_DIMENSIONS(DamageCriteria, unbreakable_parts_keep_their_bonds, 1, 2, 3)
  {
    const Settings settings = box<dim>() + Settings{{"Material/Critical stretch", "0.01"},
                                                    {"Material/Unbreakable", "x - 0.7"},
                                                    {"Material/Phases/Regions", "grip: x < 0.25"},
                                                    {"Material/Phases/Unbreakable", "grip: 1"}};
    const auto     held     = [](const Point<dim> &p) { return p[0] < 0.25 || p[0] > 0.7; };
    expect_breaks<dim>(
      settings,
      [](const Body<dim> &body) { return grown(body, 0.011); },
      0.,
      count<dim>(settings,
                 [&](const auto &p, const auto &xi) { return !held(p) && !held(p + xi); }));
    // Below, they count for nothing.
    const Body<dim> body(settings, ModelKind::peridynamics);
    EXPECT_NEAR(body.op().stretch_over_critical(grown(body, 0.009), 0.), 0.9, 1e-12);
  }


  TEST(DamageCriteria, unbreakable_parts_of_zones)
  {
    for (const char *scheme : {"exchange", "blending"})
      {
        const Settings settings = box<2>() + moves +
                                  Settings{{"Domain/Nodes", "vertices"},
                                           {"Coupling/Scheme", scheme},
                                           {"Coupling/Zone", "follow"},
                                           {"Material/Critical stretch", "0.01"}};
        const Body<2> breaks(settings, ModelKind::coupled),
          keeps(settings + Settings{{"Material/Unbreakable", "x - 0.5"}}, ModelKind::coupled);
        for (const Body<2> *body : {&breaks, &keeps})
          {
            const Vector u = grown(*body, 0.011);
            while (body->op().widen_zone(u))
              ;
            EXPECT_GT(body->op().break_bonds(u, 0.), 50u);
            std::size_t n_known = 0;
            double      last    = 0.; // place where a bond has broken
            for (const NodePair &pair : body->op().broken_since(n_known))
              for (const auto node : pair)
                {
                  const auto &layout = *body->nodes->partitioner();
                  if (layout.in_local_range(node))
                    last = std::max(last, body->position(layout.global_to_local(node))[0]);
                }
            last = max_of_all(last);
            EXPECT_EQ(last > 0.501, body == &breaks) << scheme;
          }
      }
  }


  TEST(DamageCriteria, limits_of_time_and_temperature)
  {
    const auto by = [](const std::string &stretch, const Settings &more = {}) {
      return box<2>() + more + Settings{{"Material/Critical stretch", stretch}};
    };
    const auto all  = count<2>(by("1"), [](const auto &, const auto &) { return true; });
    const auto left = count<2>(by("1"), [](const auto &p, const auto &xi) {
      return std::min(p[0], p[0] + xi[0]) < 0.5;
    });
    const auto u    = [](const Body<2> &body) { return grown(body, 0.01); };
    // The smaller limit of both ends.
    const std::string of_time = "if(x < 0.5, 0.02 - 0.011*t, 1)";
    expect_breaks<2>(by(of_time), u, 0.8, 0);
    expect_breaks<2>(by(of_time), u, 1., left);
    const Settings warm{{"Elasticity/Temperature change", "if(x < 0.5, 120, 100)"}};
    expect_breaks<2>(by("0.02 - 1e-4*(T - 10)", warm), u, 0., left);
    expect_breaks<2>(by("0.02 - 1e-4*(T - 10)*(1 + 0.2*t)", warm), u, 1., all);
    // A computed one, and back.
    const Body<2> body(by("0.02 - 1e-4*T") + moves, ModelKind::peridynamics);
    Vector        change;
    body.op().initialize_nodal_vector(change);
    for (const double warmer : {50., 101., 20.})
      {
        change = warmer;
        body.op().set_temperature_change(change);
        EXPECT_NEAR(body.op().stretch_over_critical(grown(body, 0.01), 0.),
                    0.01 / (0.02 - 1e-4 * warmer),
                    1e-12);
      }
    EXPECT_EQ(body.op().break_bonds(grown(body, 0.01), 0.), 0u);
    change = 101.;
    body.op().set_temperature_change(change);
    EXPECT_EQ(body.op().break_bonds(grown(body, 0.01), 0.), all);
  }


  TEST(DamageCriteria, fracture_energies_of_time)
  {
    // The stretch goes with the root.
    const Settings settings = box<2>() + moves;
    const Body<2>  fixed(settings + Settings{{"Material/Fracture energy", "0.01"}},
                        ModelKind::peridynamics),
      falling(settings + Settings{{"Material/Fracture energy", "0.04/(1 + t)^2"}},
              ModelKind::peridynamics);
    const double ratio = fixed.op().stretch_over_critical(grown(fixed, 0.01), 0.);
    for (const double t : {0., 1., 3.})
      EXPECT_NEAR(falling.op().stretch_over_critical(grown(falling, 0.01), t),
                  ratio * (1. + t) / 2.,
                  1e-12);
    EXPECT_THROW(falling.op().stretch_over_critical(grown(falling, 0.01), -1.), UserError);
  }


  namespace
  {
    const Settings by_energy{{"Material/Fracture energy", "0.01"},
                             {"Material/Criterion", "energy"},
                             {"Peridynamics/Kernel", "constant"}};


    /** The criterion of a body of peridynamics at u. */
    template <int dim>
    BondEnergies<dim> energies_of(const Body<dim> &body, const Vector &u)
    {
      const SolidBonds<dim> &bonds = body.states->bonds();
      BondEnergies<dim>      energies({bonds.families, body.scene.material, {}, {}},
                                 body.scene.peridynamics.sampling.volume_fraction);
      energies.take_state(nodal_tensions(bonds, u));
      return energies;
    }
  } // namespace


  TEST_IN_DIMENSIONS(DamageCriteria, bonds_have_the_strain_energy, 1, 2, 3)
  {
    constexpr double s = 0.01;
    for (const char *model : {"state-based", "bond-based"})
      for (const char *exponent : {"0", "1", "2"})
        {
          const Body<dim> body(
            box<dim>() + by_energy +
              Settings{{"Elasticity/Model", model}, {"Peridynamics/Kernel exponent", exponent}},
            ModelKind::peridynamics);
          const Vector            u        = grown(body, s);
          const BondEnergies<dim> energies = energies_of(body, u);
          double                  stored   = 0.;
          for (unsigned int i = 0; i < body.nodes->n_owned(); ++i)
            body.states->bonds().rows.for_each_in_body(i, [&](const auto &bond) {
              const BondMeasure found = energies.measure(i, bond.neighbor, s, 1.);
              const auto        xi    = body.states->bonds().ends.vector(i, bond.neighbor);
              stored += 0.25 * found.value * found.value * energies.part(xi) *
                        body.nodes->volume(i) * body.nodes->volume(bond.neighbor);
            });
          const double expected = body.op().energy(u);
          EXPECT_NEAR(sum_of_all(stored), expected, 1e-10 * expected) << model << exponent;
        }
  }


  TEST(DamageCriteria, energies_of_the_bond_based_solid_are_stretches_of_each_length)
  {
    // W x^2 does not depend on x with exponent 2, but where the horizon cuts volumes.
    const Body<3>      body(box<3>() + by_energy +
                         Settings{{"Domain/Cells", "12, 9, 6"},
                                  {"Elasticity/Model", "bond-based"},
                                  {"Peridynamics/Horizon ratio", "3"},
                                  {"Peridynamics/Volume fraction", "none"},
                                  {"Peridynamics/Kernel exponent", "1"}},
                       ModelKind::peridynamics);
    const auto        &bonds    = body.states->bonds();
    const BondEnergies energies = energies_of(body, body.vector());
    double             least = 1e300, most = 0.;
    for (unsigned int i = 0; i < body.nodes->n_owned(); ++i)
      bonds.rows.for_each_in_body(i, [&](const auto &bond) {
        const double x   = bonds.families.neighbors().bond_vector(i, bond.neighbor).norm();
        const double s_c = 0.01 / energies.measure(i, bond.neighbor, 0.01, 1.).over_limit();
        const double k   = bonds.laws.stiffness(i) + bonds.laws.stiffness(bond.neighbor);
        least            = std::min(least, s_c * std::sqrt(k * x));
        most             = std::max(most, s_c * std::sqrt(k * x));
      });
    EXPECT_NEAR(max_of_all(most) / -max_of_all(-least), 1., 1e-10);
    // w_c of the continuum; the sums over a lattice come near to its integrals.
    const double delta = body.scene.horizon();
    EXPECT_NEAR(energies.of_nodes()[0] * 3.14159265358979 * std::pow(delta, 4) / 0.04, 1., 0.1);
  }


  namespace
  {
    /**
     * Energy per area that a body has released when it is pulled apart, little by little, at a
     * plane at an angle to its rows, over the fracture energy, by bonds that cross in its middle.
     */
    double released_over_energy(const double angle, const std::string &model)
    {
      const Settings settings = box<2>() + moves + by_energy +
                                Settings{{"Domain/Upper corner", "1, 1"},
                                         {"Domain/Cells", "24, 24"},
                                         {"Elasticity/Model", model},
                                         {"Peridynamics/Horizon ratio", "5"},
                                         {"Peridynamics/Kernel exponent", "1"}};
      const Body<2> body(settings + Settings{{"Peridynamics/Operator form", "stored"}},
                         ModelKind::peridynamics),
        lattice(settings + Settings{{"Peridynamics/Operator form", "lattice"}},
                ModelKind::peridynamics);
      const Tensor<1, 2> n({std::cos(angle), std::sin(angle)}), along({-n[1], n[0]});
      const Point<2>     middle(0.5 + 1.3e-5, 0.5 + 0.7e-5);
      const double       half   = angle == 0. ? 0.25 : std::sqrt(0.5) * 8. / 24.;
      const auto         opened = [&](const double a) {
        return body.values(
          [&](const Point<2> &p) { return Tensor<1, 2>((p - middle) * n > 0. ? a * n : 0. * n); });
      };
      double a = 1., most;
      while ((most = body.op().stretch_over_critical(opened(a), 0.)) > 0.)
        {
          a *= 1.001 / most;
          const auto n_broken = body.op().break_bonds(opened(a), 0.);
          EXPECT_EQ(lattice.op().break_bonds(opened(a), 0.), n_broken);
        }
      const BondEnergies<2> energies = energies_of(body, body.vector());
      const auto           &layout   = *body.nodes->partitioner();
      std::size_t           n_known  = 0;
      double                crossing = 0., all = 0.;
      for (const NodePair &pair : body.op().broken_since(n_known))
        {
          const unsigned int i    = layout.global_to_local(pair[0]),
                             j    = layout.global_to_local(pair[1]);
          const Tensor<1, 2> from = body.nodes->position(i) - middle,
                             to   = body.nodes->position(j) - middle;
          EXPECT_LT((from * n) * (to * n), 0.); // it crosses the plane
          const double energy = energies.of_nodes()[i] * energies.part(to - from) *
                                body.nodes->volume(i) * body.nodes->volume(j);
          const double share = (from * n) / ((from - to) * n);
          all += energy;
          crossing += std::abs((from + share * (to - from)) * along) < half ? energy : 0.;
        }
      const double released = body.op().released_energy() / sum_of_all(all);
      // What broke had stored its share, but for the steps of the opening.
      if (model == "bond-based")
        {
          EXPECT_NEAR(released, 1., 0.01);
        }
      return released * sum_of_all(crossing) / (2. * half * 0.01);
    }
  } // namespace


  TEST(DamageCriteria, energy_of_a_plane_that_is_pulled_open)
  {
    for (const double angle : {0., std::atan(1.)})
      EXPECT_NEAR(released_over_energy(angle, "bond-based"), 1., 0.01) << angle;
    // What a bond of the state-based solid has stored when it breaks is not all that goes with it.
    EXPECT_NEAR(released_over_energy(0., "state-based"), 0.973, 0.01);
  }


  namespace
  {
    Settings by_stress(const std::string &criterion, const std::string &model)
    {
      return box<2>() + moves +
             Settings{{"Material/Criterion", criterion},
                      {"Material/Critical stress", "0.03"},
                      {"Elasticity/Model", model}};
    }


    double ratio(const Settings &settings, const Tensor<2, 2> &gradient, const double t = 0.)
    {
      const Body<2> body(settings, ModelKind::peridynamics);
      return body.op().stretch_over_critical(
        body.values([&](const Point<2> &p) { return gradient * p; }),
        t);
    }
  } // namespace


  TEST(DamageCriteria, stresses_of_uniform_strains)
  {
    // E = 3, nu = 0.2, plane stress; 1/100 of it and of the shear modulus.
    Tensor<2, 2> pulled, sheared;
    pulled[0][0]  = 0.01;
    pulled[1][1]  = -0.002;
    sheared[0][1] = sheared[1][0] = 0.012;
    const Tensor<2, 2> turned({{0., -0.3}, {0.3, 0.}});
    // Families that end at sides have stresses of other strains: up to 1.23 times these.
    const Settings inside{{"Material/Unbreakable", "0.22 - min(min(x, 1 - x), min(y, 0.75 - y))"}};
    for (const char *model : {"correspondence", "state-based"})
      {
        // Of state-based families the sums over a lattice: 1.008 and 1.012 with m = 3.
        const double bound     = std::string(model) == "correspondence" ? 1e-9 : 0.015;
        const auto   principal = by_stress("principal stress", model) + inside,
                   mises       = by_stress("von mises", model) + inside;
        EXPECT_NEAR(ratio(principal, pulled), 1., bound) << model;
        EXPECT_NEAR(ratio(mises, pulled), 1., bound) << model;
        EXPECT_NEAR(ratio(principal, pulled + turned), 1., bound) << model;
        EXPECT_NEAR(ratio(mises, sheared) / ratio(principal, sheared), std::sqrt(3.), bound)
          << model;
        EXPECT_LT(ratio(principal, -1. * pulled), bound) << model; // stretched across, no tension
        EXPECT_NEAR(ratio(mises, -1. * pulled), 1., bound) << model;
      }
    const Settings changes{{"Material/Critical stress", "0.03/(1 + t)"}};
    EXPECT_NEAR(ratio(by_stress("von mises", "correspondence") + changes, pulled, 1.), 2., 1e-10);
  }


  TEST(DamageCriteria, bonds_near_the_tension_break)
  {
    Tensor<2, 2> pulled;
    pulled[0][0]            = 0.0101;
    pulled[1][1]            = -0.00202;
    const Settings settings = by_stress("principal stress", "correspondence");
    const auto     u        = [&](const Body<2> &body) {
      return body.values([&](const Point<2> &p) { return pulled * p; });
    };
    const auto near      = count<2>(settings, [](const auto &, const auto &xi) {
      return std::abs(xi[0]) > std::abs(xi[1]) * (1. - 1e-9);
    });
    const auto stretched = count<2>(settings, [](const auto &, const auto &xi) {
      return 0.0101 * xi[0] * xi[0] > 0.00202 * xi[1] * xi[1];
    });
    for (const bool is_mises : {false, true})
      for (const char *form : {"stored", "auto"})
        {
          const Body<2> body(
            by_stress(is_mises ? "von mises" : "principal stress", "correspondence") +
              Settings{{"Peridynamics/Operator form", form}},
            ModelKind::peridynamics);
          EXPECT_EQ(body.op().break_bonds(u(body), 0.), is_mises ? stretched : near);
        }
  }


  TEST(DamageCriteria, stresses_on_lattice_and_stored)
  {
    // Of a field that is not linear: the same bonds in both forms, and without damage none.
    for (const char *criterion : {"principal stress", "von mises", "energy"})
      {
        const bool         is_energy = std::string(criterion) == "energy";
        std::set<NodePair> pairs[2];
        for (const bool on_lattice : {false, true})
          {
            const Body<2> body(
              (is_energy ? box<2>() + moves + by_energy : by_stress(criterion, "state-based")) +
                Settings{{"Domain/Cells", "40, 30"},
                         {"Peridynamics/Operator form", on_lattice ? "lattice" : "stored"}},
              ModelKind::peridynamics);
            const Vector u =
              body.values([](const Point<2> &p) { return 0.02 * bumpy_vector<2>(p); });
            EXPECT_GT(body.op().break_bonds(u, 0., 0.9), 2u) << criterion;
            std::size_t n_known = 0;
            for (const NodePair &pair : body.op().broken_since(n_known))
              pairs[on_lattice].insert(pair);
          }
        EXPECT_TRUE(pairs[0] == pairs[1]) << criterion;
      }
  }
} // namespace PeriDeal
