// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Laws of bonds other than the linear one: by themselves, in peridynamics alone, beside elements.

#include <perideal/base/archive.h>
#include <perideal/laws/bond_force_formula.h>
#include <perideal/laws/viscoelastic_solid.h>

#include <cmath>
#include <functional>

#include "elastic_test_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;
using dealii::Point;
using dealii::Tensor;

namespace
{
  const std::vector<Relaxation> terms{{0.3, 1.}, {0.4, 10.}};

  const Settings viscous{{"Material/Law", "viscoelastic"},
                         {"Material/Relaxation", "0.3, 1 ; 0.4, 10"}};

  const Settings nodal{{"Elasticity/Model", "correspondence"}, {"Peridynamics/Horizon ratio", "2"}};

  /** The relaxation function, and its integral. */
  double relaxed(const double t)
  {
    return 0.3 + 0.3 * std::exp(-t) + 0.4 * std::exp(-t / 10.);
  }

  double integral(const double t)
  {
    return 0.3 * t - 0.3 * std::expm1(-t) - 4. * std::expm1(-t / 10.);
  }


  Settings formula(const std::string &force)
  {
    return {{"Material/Law", "formula"},
            {"Material/Bond force", force},
            {"Elasticity/Solver", "conjugate gradients"}};
  }


  /** A body of each kind, alone or with all of its nodes in an overlap. */
  struct Kind
  {
    const char *name;
    ModelKind   model;
    Settings    more;
  };

  template <int dim>
  std::vector<Kind> kinds()
  {
    const Settings blended   = Settings{{"Coupling/Zone", "x < 0.5"},
                                      {"Coupling/Scheme", "blending"},
                                      {"Coupling/Overlap", "2"}};
    const Settings completed = Settings{{"Peridynamics/Surface correction", "fictitious nodes"}};
    return {{"peridynamics", ModelKind::peridynamics, {}},
            {"stored", ModelKind::peridynamics, {{"Peridynamics/Operator form", "stored"}}},
            {"completed", ModelKind::peridynamics, completed},
            {"correspondence", ModelKind::peridynamics, nodal},
            {"correspondence, stored",
             ModelKind::peridynamics,
             nodal + Settings{{"Peridynamics/Operator form", "stored"}}},
            {"correspondence, completed", ModelKind::peridynamics, nodal + completed},
            {"full",
             ModelKind::peridynamics,
             {{"Elasticity/Kinematics", "full"}, {"Elasticity/Solver", "conjugate gradients"}}},
            {"elements", ModelKind::finite_elements, {}},
            {"blending", ModelKind::coupled, blended},
            {"correspondence, blending", ModelKind::coupled, blended + nodal},
            {"blending, breaking",
             ModelKind::coupled,
             blended + Settings{{"Material/Critical stretch", "10"}}}};
  }


  template <int dim>
  Settings solid()
  {
    return box<dim>() + (dim == 2 ? Settings{{"Elasticity/Plane", "strain"}} : Settings());
  }


  double worst_difference(const Vector &a, const Vector &b)
  {
    Vector difference(a);
    difference -= b;
    return difference.linfty_norm();
  }


  template <int dim>
  NodeKeys keys_of(const Body<dim> &body)
  {
    NodeKeys keys;
    Vector   x;
    body.op().initialize_vector(x);
    for (unsigned int i = 0; i < x.locally_owned_size() / dim; ++i)
      {
        std::uint64_t key = 0;
        for (unsigned int d = 0; d < dim; ++d)
          key = (key << 20) + std::llround(1e4 * (body.position(i)[d] + 1.));
        keys.push_back(key);
      }
    return keys;
  }
} // namespace


TEST(ViscoelasticSolid, ramp_and_steps_against_closed_forms)
{
  ViscoelasticSolid law(terms);
  for (const double jump : {0., 2.})
    {
      std::vector<double> history(law.n_history(), 0.);
      law.set_step(0.);
      law.accept({jump, 1.}, history.data());
      double t = 0., dissipated = 0., work = 0.5 * jump * jump;
      for (const double dt : {0.1, 3., 1e-9, 0.5, 20.})
        {
          law.set_step(dt);
          // A bond that is pulled at a rate of 1.
          const BondValues now{jump + t + dt, 1.};
          EXPECT_NEAR(law.effective(now, history.data()),
                      jump * relaxed(t + dt) + integral(t + dt),
                      1e-12 * now.product);
          // The force is that of the steps before and of this one, whose work is exact by Simpson's
          // rule on 200 parts.
          const unsigned int n = 200;
          for (unsigned int k = 0; k <= n; ++k)
            {
              const double at = t + dt * k / n;
              work += (k == 0 || k == n ? 1. :
                       k % 2 == 1       ? 4. :
                                          2.) *
                      dt / (3. * n) * (jump * relaxed(at) + integral(at));
            }
          dissipated += law.energy(now, history.data(), true);
          EXPECT_NEAR(law.energy(now, history.data(), false) + dissipated, work, 1e-9 * work);
          EXPECT_GE(law.energy(now, history.data(), true), 0.);
          law.accept(now, history.data());
          t += dt;
        }
    }
}


TEST(ViscoelasticSolid, trials_leave_nothing_behind)
{
  ViscoelasticSolid   law(terms);
  std::vector<double> history(law.n_history(), 0.);
  law.set_step(0.);
  law.accept({1., 1.}, history.data());
  law.set_step(7.);
  const double first = law.effective({3., 1.}, history.data());
  law.set_step(0.5);
  law.effective({-2., 1.}, history.data());
  law.set_step(7.);
  EXPECT_EQ(law.effective({3., 1.}, history.data()), first);
}


TEST(BondForceFormula, energy_slope_and_the_linear_law)
{
  const BondForceFormula linear([](const double s, const double) { return s; });
  const BondForceFormula curved(
    [](const double s, const double damage) { return (1. - damage) * (s - 2. * s * s * s); });
  for (const double product : {0.3, -0.01, 1e-7, 0.})
    {
      const BondValues bond{product, 1.7, 0.25};
      EXPECT_EQ(linear.effective(bond, nullptr), product);
      EXPECT_NEAR(linear.energy(bond, nullptr, false), 0.5 * product * product, 1e-15);
      const double s = bond.stretch();
      EXPECT_NEAR(curved.effective(bond, nullptr), 1.7 * 0.75 * (s - 2. * s * s * s), 1e-15);
      EXPECT_NEAR(curved.energy(bond, nullptr, false),
                  1.7 * 1.7 * 0.75 * (0.5 * s * s - 0.5 * s * s * s * s),
                  1e-15);
      EXPECT_NEAR(curved.slope(bond, nullptr), 0.75 * (1. - 6. * s * s), 1e-8);
    }
}


namespace
{
  /**
   * A body that is deformed at once, then held, then deformed on: forces are those of the bulk
   * modulus, and those of the shear modulus that relax; and where energy is.
   */
  template <int dim>
  void relaxes(const Kind &kind)
  {
    SCOPED_TRACE(std::to_string(dim) + "D, " + kind.name);
    const auto body_of = [&](const char *bulk, const Settings &more) {
      return std::make_unique<Body<dim>>(solid<dim>() + kind.more +
                                           Settings{{"Material/Young modulus", ""},
                                                    {"Material/Poisson ratio", ""},
                                                    {"Material/Shear modulus", "1.5"},
                                                    {"Material/Bulk modulus", bulk}} +
                                           more,
                                         kind.model);
    };
    const auto body_now = body_of("1", viscous);
    Body<dim> &body     = *body_now;
    // With full kinematics rotations change forces by the square of displacements.
    const bool   full = std::string(kind.name) == "full";
    const double size = full ? 1e-7 : 1., tolerance = full ? 1e-5 : 1e-11;
    const auto   deformed = [&](const double factor) {
      return body.values(
        [&](const Point<dim> &p) { return Tensor<1, dim>(factor * size * bumpy_vector<dim>(p)); });
    };
    Vector of_bulk(deformed(0.)), of_shear(of_bulk), found(of_bulk), wanted(of_bulk);
    body_of("1", {})->op().unbalanced(of_shear, deformed(1.), 0.);
    body_of("2", {})->op().unbalanced(of_bulk, deformed(1.), 0.);
    of_bulk -= of_shear; // forces are linear in both
    of_shear -= of_bulk;
    const double largest = of_shear.linfty_norm();
    const auto   expect  = [&](const double now, const double t, const double history) {
      body.op().unbalanced(found, deformed(now), t);
      wanted = of_bulk;
      wanted *= now;
      wanted.add(history, of_shear);
      EXPECT_LT(worst_difference(found, wanted), tolerance * largest) << "t = " << t;
    };
    expect(2., 0., 2.);
    const double start = body.op().energy(deformed(2.));
    body.op().accept(deformed(2.), 0.);
    EXPECT_EQ(body.op().released().by_law, 0.);
    expect(2., 5., 2. * relaxed(5.)); // one that is given up
    for (const double t : {0.25, 3.})
      {
        expect(2., t, 2. * relaxed(t));
        body.op().accept(deformed(2.), t);
        EXPECT_NEAR(body.op().energy(deformed(2.)) + body.op().released().by_law,
                    start,
                    1e-11 * start);
      }
    EXPECT_GT(body.op().released().by_law, 0.1 * start);
    expect(2.5, 4., 2. * relaxed(4.) + 0.5 * integral(1.));

    // Archived, and taken up by another one.
    MemoryArchive saved(MPI_COMM_WORLD);
    body.op().exchange(saved, keys_of(body));
    const auto    resumed_now = body_of("1", viscous);
    Body<dim>    &resumed     = *resumed_now;
    MemoryArchive loaded(saved, MPI_COMM_WORLD);
    resumed.op().exchange(loaded, keys_of(resumed));
    resumed.op().unbalanced(wanted, deformed(2.5), 4.);
    body.op().unbalanced(found, deformed(2.5), 4.);
    EXPECT_EQ(worst_difference(found, wanted), 0.);
    EXPECT_EQ(resumed.op().released().by_law, body.op().released().by_law);
  }


  /** Forces are those of the energy, and K their derivative. */
  template <int dim>
  void has_energy(const Settings &settings,
                  const ModelKind model,
                  const double    t,
                  const bool      breaks = false)
  {
    const Settings weak{{"Material/Critical stretch", "0.05"}, {"Elasticity/Contact", "false"}};
    Body<dim>      body(breaks ? settings + weak : settings, model);
    const auto     values = [&](const double size) {
      return body.values(
        [&](const Point<dim> &p) { return Tensor<1, dim>(size * bumpy_vector<dim>(p)); });
    };
    const Vector u         = values(0.05);
    Vector       direction = body.values([](const Point<dim> &p) {
      Point<dim> q;
      for (unsigned int d = 0; d < dim; ++d)
        q[d] = 1.3 * p[dim - 1 - d] + 0.2;
      return bumpy_vector<dim>(q);
    });
    body.op().accept(values(0.03), 0.);
    if (breaks) // what they went through is no matter any more
      {
        EXPECT_GT(body.op().break_bonds(values(0.03), 0., 0.), 0u);
      }
    const double step = 1e-5;
    Vector       up(u), down(u), forces(u), of_up(u), of_down(u), image(u);
    up.add(step, direction);
    down.add(-step, direction);
    body.op().unbalanced(of_up, up, t);
    const double above = body.op().energy(up);
    body.op().unbalanced(of_down, down, t);
    const double below = body.op().energy(down);
    body.op().unbalanced(forces, u, t);
    body.op().linearize(u);
    body.op().multiply(image, direction);
    if (t == 0.)
      {
        EXPECT_NEAR((above - below) / (2. * step),
                    -(forces * direction),
                    1e-6 * forces.l2_norm() * direction.l2_norm());
      }
    of_up -= of_down;
    of_up *= -0.5 / step;
    EXPECT_LT(worst_difference(of_up, image), 1e-5 * image.linfty_norm());
  }
} // namespace


TEST(BondLaws, shear_modulus_relaxes)
{
  for (const Kind &kind : kinds<2>())
    relaxes<2>(kind);
  for (const Kind &kind : kinds<3>())
    if (std::string(kind.name).find("completed") == std::string::npos)
      relaxes<3>(kind);
}


TEST(BondLaws, tangents_and_energies)
{
  const std::string curved = "s*(1 - 3*abs(s) + 5*s^2)";
  for (const Kind &kind : kinds<2>())
    {
      const std::string name = kind.name;
      SCOPED_TRACE(name);
      // The energy of a law with a history is that of the instant.
      for (const double t : {0., 1.5})
        has_energy<2>(solid<2>() + viscous + kind.more, kind.model, t);
      if (kind.model == ModelKind::finite_elements)
        continue;
      if (name.find("correspondence") == std::string::npos)
        has_energy<2>(solid<2>() + kind.more + formula(curved), kind.model, 0.);
      if (name.find("completed") == std::string::npos && // whose bonds do not break
          name != "correspondence, blending")
        has_energy<2>(solid<2>() + viscous + kind.more, kind.model, 0., true);
    }
  has_energy<2>(solid<2>() + kinds<2>()[8].more +
                  Settings{{"Coupling/Scheme", "exchange"},
                           {"Coupling/Zone", "everywhere"},
                           {"Coupling/Overlap", "0"}} +
                  formula(curved),
                ModelKind::coupled,
                0.);
}


namespace
{
  /**
   * Histories at nodes are those of each bond, also where bonds break: forces, stresses, and
   * energies of a body that is deformed now this way, now that.
   */
  template <int dim>
  void remembers_as_bonds(const Settings &more, const bool breaks)
  {
    const Settings settings =
      solid<dim>() + viscous + more +
      (breaks ? Settings{{"Material/Critical stretch", "0.06"}, {"Elasticity/Contact", "false"}} :
                Settings());
    const auto body_of = [&](const char *form) {
      return std::make_unique<Body<dim>>(settings + Settings{{"Peridynamics/Operator form", form}},
                                         ModelKind::peridynamics);
    };
    const auto of_nodes = body_of("auto"), of_bonds = body_of("stored");
    EXPECT_NE(of_nodes->states->bonds().relaxing(), nullptr);
    EXPECT_EQ(of_bonds->states->bonds().relaxing(), nullptr);
    const auto at = [&](const double t) {
      return of_nodes->values([&](Point<dim> p) {
        for (unsigned int d = 0; d < dim; ++d)
          p[d] += 0.4 * t * (1. + d);
        return Tensor<1, dim>(0.01 * bumpy_vector<dim>(p));
      });
    };
    Vector found(at(0.)), wanted(found);
    for (const double t : {0., 0.3, 1.1, 4., 4.1})
      {
        const Vector u = at(t);
        of_nodes->op().unbalanced(found, u, t);
        of_bonds->op().unbalanced(wanted, u, t);
        EXPECT_LT(worst_difference(found, wanted), 1e-12 * wanted.linfty_norm()) << t;
        const auto tensors = of_nodes->states->tensors(u), expected = of_bonds->states->tensors(u);
        for (unsigned int i = 0; i < tensors.stress.size(); ++i)
          {
            EXPECT_LT((tensors.stress[i] - expected.stress[i]).norm(), 1e-12);
            EXPECT_LT((tensors.strain[i] - expected.strain[i]).norm(), 1e-12);
          }
        of_nodes->op().accept(u, t);
        of_bonds->op().accept(u, t);
        if (breaks && t > 1.)
          {
            EXPECT_EQ(of_nodes->op().break_bonds(u, t), of_bonds->op().break_bonds(u, t));
            EXPECT_NEAR(of_nodes->op().break_history()->released,
                        of_bonds->op().break_history()->released,
                        1e-12 * of_bonds->op().break_history()->released);
          }
        const double energy = of_bonds->op().energy(u);
        EXPECT_NEAR(of_nodes->op().energy(u), energy, 1e-12 * energy);
        EXPECT_NEAR(of_nodes->op().released().by_law,
                    of_bonds->op().released().by_law,
                    1e-12 * energy);
      }
    EXPECT_EQ(of_nodes->op().n_broken_bonds() > 0, breaks);
  }


  /** Stress of a uniform strain that jumps, then grows: that of the law, at all nodes. */
  template <int dim>
  void has_uniform_stress()
  {
    const Body<dim> body(solid<dim>() + nodal + viscous, ModelKind::peridynamics);
    const Moduli    moduli = body.scene.material.moduli(Point<dim>());
    const auto      strain = symmetrize(some_gradient<dim>());
    double          t      = 0.;
    for (const double dt : {0., 0.1, 3., 1e-9, 0.5, 20.})
      {
        t += dt;
        const Vector u =
          body.values([&](const Point<dim> &p) { return (1. + t) * linear_field<dim>(p); });
        const double shear = moduli.shear * (relaxed(t) + integral(t)), bulk = moduli.bulk;
        Vector       forces(u);
        body.op().unbalanced(forces, u, t);
        const auto now = body.states->tensors(u);
        for (unsigned int i = 0; i < now.stress.size(); ++i)
          {
            const auto wanted = 2. * shear * strain + (bulk * (1. + t) - 2. / 3. * shear) *
                                                        trace(strain) *
                                                        dealii::unit_symmetric_tensor<dim>();
            EXPECT_LT((now.stress[i] - wanted).norm(), 1e-12 * (1. + t)) << t;
            if (dim == 2)
              {
                EXPECT_NEAR(now.out_of_plane[i],
                            (bulk * (1. + t) - 2. / 3. * shear) * trace(strain),
                            1e-12 * (1. + t));
              }
          }
        body.op().accept(u, t);
      }
  }
} // namespace


TEST(BondLaws, nodes_remember_as_bonds)
{
  remembers_as_bonds<2>({}, false);
  remembers_as_bonds<2>({}, true);
  remembers_as_bonds<2>({{"Peridynamics/Surface correction", "fictitious nodes"}}, false);
  remembers_as_bonds<2>({{"Peridynamics/Surface correction", "energy"}}, false);
  remembers_as_bonds<2>({{"Material/Young modulus", "3 + y"},
                         {"Boundary conditions/Symmetry", "bottom"},
                         {"Peridynamics/Surface correction", "auto"},
                         {"Cracks/Segments", "0.21,0.34 ; 0.66,0.43"},
                         {"Elasticity/Contact", "false"}},
                        false);
  remembers_as_bonds<3>({}, true);
}


TEST(BondLaws, uniform_stress_of_correspondence)
{
  has_uniform_stress<2>();
  has_uniform_stress<3>();
}


TEST(BondLaws, formula_of_the_linear_law)
{
  for (const bool full : {false, true})
    {
      const Settings settings =
        solid<2>() + Settings{{"Elasticity/Solver", "conjugate gradients"},
                              {"Elasticity/Kinematics", full ? "full" : "linear"},
                              {"Peridynamics/Operator form", "stored"}};
      const Body<2> linear(settings, ModelKind::peridynamics),
        by_formula(settings + formula("s"), ModelKind::peridynamics);
      const Vector u =
        linear.values([](const Point<2> &p) { return Tensor<1, 2>(0.1 * bumpy_vector<2>(p)); });
      Vector a(u), b(u);
      linear.op().unbalanced(a, u, 0.);
      by_formula.op().unbalanced(b, u, 0.);
      // Full kinematics of the linear law take several bonds at once.
      EXPECT_LE(worst_difference(a, b), full ? 1e-13 * a.linfty_norm() : 0.);
      EXPECT_NEAR(linear.op().energy(u), by_formula.op().energy(u), 1e-13 * linear.op().energy(u));
    }
}
