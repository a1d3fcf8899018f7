// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Peridynamics alone that yields: forces, tangents, energies of whole bodies, and what they
// remember. What a node makes of its family stands in ordinary_plasticity_test.cc.

#include <deal.II/base/symmetric_tensor.h>

#include <perideal/base/archive.h>

#include <cmath>

#include "body_waves.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;
using dealii::Point;
using dealii::Tensor;

namespace
{
  const Settings plastic{{"Material/Law", "plastic"},
                         {"Material/Yield stress", "0.3"},
                         {"Material/Hardening modulus", "0.2"},
                         {"Elasticity/Solver", "newton"}};

  const Settings completed{{"Peridynamics/Surface correction", "fictitious nodes"}};

  struct Kind
  {
    const char *name;
    Settings    more;
  };

  template <int dim>
  std::vector<Kind> kinds()
  {
    if (dim == 3)
      return {{"3D", {}}, {"3D, completed", completed}};
    const Settings strain{{"Elasticity/Plane", "strain"}}, stress{{"Elasticity/Plane", "stress"}};
    return {
      {"plane strain", strain},
      {"plane strain, completed", strain + completed},
      {"plane strain, cracked",
       strain + completed +
         Settings{{"Cracks/Segments", "0.21,0.34 ; 0.66,0.43"}, {"Elasticity/Contact", "false"}}},
      {"plane stress", stress},
      {"plane stress, phases",
       stress + Settings{{"Material/Yield stress", "0.3 + 0.4*x"},
                         {"Material/Hardening modulus", "0.1 + y"},
                         {"Material/Young modulus", "3 + y"}}}};
  }


  template <int dim>
  const YieldingFamilies<dim> &yielding(const Body<dim> &body)
  {
    return *body.states->bonds().yielding();
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
    for (unsigned int i = 0; i < body.n_owned(); ++i)
      {
        std::uint64_t key = 0;
        for (unsigned int d = 0; d < dim; ++d)
          key = (key << 20) + std::llround(1e4 * (body.position(i)[d] + 1.));
        keys.push_back(key);
      }
    return keys;
  }


  template <int dim>
  double share_that_yielded(const Body<dim> &body)
  {
    double n = 0.;
    for (unsigned int i = 0; i < body.n_owned(); ++i)
      n += yielding(body).plastic_strain(i) > 0. ? 1. : 0.;
    const MPI_Comm all = body.nodes->communicator();
    return dealii::Utilities::MPI::sum(n, all) / body.nodes->n_global();
  }


  /**
   * Forces are the slope of what the step stores and dissipates, the tangent is that of the forces,
   * symmetric and positive.
   */
  template <int dim>
  void expect_slopes(const Kind &kind)
  {
    SCOPED_TRACE(kind.name);
    Body<dim>    body(box<dim>() + plastic + kind.more, ModelKind::peridynamics);
    const double size = dim == 3 ? 0.45 : 1.;
    body.op().accept(waves(body, 0.02 * size, 0.), 0.);
    body.op().accept(waves(body, 0.025 * size, 0.2), 1.);
    const double yielded = share_that_yielded(body);
    EXPECT_GT(yielded, 0.2);
    EXPECT_LT(yielded, 1.);
    const Vector u = waves(body, 0.03 * size, 0.5), direction = waves(body, 1., 2.),
                 other = waves(body, 1., 3.);
    const double step  = 1e-7;
    Vector       up(u), down(u), forces(u), of_up(u), of_down(u), image(u), of_other(u);
    up.add(step, direction);
    down.add(-step, direction);
    const auto spent = [&](const Vector &at) {
      return body.op().energy(at) + yielding(body).plastic_work(at);
    };
    body.op().unbalanced(of_up, up, 2.);
    const double above = spent(up);
    body.op().unbalanced(of_down, down, 2.);
    const double below = spent(down);
    body.op().unbalanced(forces, u, 2.);
    const double most = forces.l2_norm() * direction.l2_norm();
    EXPECT_NEAR((above - below) / (2. * step), -(forces * direction), 1e-7 * most);
    body.op().linearize(u);
    body.op().multiply(image, direction);
    body.op().multiply(of_other, other);
    of_up -= of_down;
    of_up *= -0.5 / step;
    EXPECT_LT(worst_difference(of_up, image), 1e-6 * image.linfty_norm());
    EXPECT_NEAR(other * image, direction * of_other, 1e-12 * other.l2_norm() * image.l2_norm());
    EXPECT_GT(direction * image, 0.);
    // It is softer than the elastic body, which is what steps are chosen by.
    body.op().spectrum();
    body.op().multiply(of_other, direction);
    EXPECT_LT(direction * image, 0.9 * (direction * of_other));
  }


  /** Complete families all see a uniform strain, and do what one of them does by itself. */
  template <int dim>
  void expect_uniform(const Settings &more)
  {
    Body<dim> body(box<dim>() + plastic + completed + more, ModelKind::peridynamics);
    struct Bond
    {
      Tensor<1, dim> xi;
      double         weight, plastic = 0.;
    };
    const Families<dim> &families = body.states->bonds().families;
    const Tensor<1, dim> h        = body.scene.domain.spacing();
    const Moduli         moduli   = body.scene.material.moduli(Point<dim>());
    OrdinaryPlasticity   law(moduli, dim, body.scene.elasticity.plane, 0.3, 0.2);
    std::vector<Bond>    bonds;
    double               q = 0., dissipated = 0., stored = 0.;
    for (const auto &member : families.weights().members())
      {
        Bond bond;
        for (unsigned int d = 0; d < dim; ++d)
          bond.xi[d] = member.offset[d] * h[d];
        bond.weight = member.weight;
        q += bond.weight * bond.xi.norm_square();
        bonds.push_back(bond);
      }
    const double              alpha = dim * (dim + 2.) * moduli.shear / q;
    OrdinaryPlasticity::State state;
    Vector                    forces;
    body.op().initialize_vector(forces);
    double volume = 1.;
    for (unsigned int d = 0; d < dim; ++d)
      volume *= body.scene.domain.upper[d] - body.scene.domain.lower[d];
    for (const double size : {0.1, 0.4, 0.6, 0.2})
      {
        Tensor<2, dim> gradient = size * some_gradient<dim>();
        gradient[0][1] += size * size;
        double theta = 0., sum = 0.;
        for (const Bond &bond : bonds)
          theta += dim * bond.weight / q * (bond.xi * (gradient * bond.xi));
        const auto elastic = [&](const Bond &bond) {
          return bond.xi * (gradient * bond.xi) / bond.xi.norm_square() - theta / dim -
                 bond.plastic;
        };
        for (const Bond &bond : bonds)
          sum += 0.5 * alpha * bond.weight * bond.xi.norm_square() * elastic(bond) * elastic(bond);
        const auto answer = law.answer(theta, sum, state);
        for (Bond &bond : bonds)
          bond.plastic += (1. - answer.ratio) * elastic(bond);
        state.strain += answer.change.strain;
        state.plane += answer.change.plane;
        stored = answer.stored;
        dissipated += answer.dissipated;

        const Vector u =
          body.values([&](const Point<dim> &p) { return Tensor<1, dim>(gradient * p); });
        body.op().unbalanced(forces, u, size);
        EXPECT_NEAR(body.op().energy(u), stored * volume, 1e-12 * stored * volume);
        EXPECT_NEAR(yielding(body).plastic_work(u), answer.dissipated * volume, 1e-12 * volume);
        body.op().accept(u, size);
        EXPECT_NEAR(body.op().energy(u), stored * volume, 1e-12 * stored * volume);
        for (unsigned int i = 0; i < body.n_owned(); ++i)
          EXPECT_NEAR(yielding(body).plastic_strain(i), state.strain, 1e-12);
      }
    EXPECT_GT(dissipated, 0.1 * stored);
    // Forces at nodes that no fictitious one follows: none.
    const double reach = families.weights().reach();
    for (unsigned int i = 0; i < body.n_owned(); ++i)
      {
        double inside = 1e300;
        for (unsigned int d = 0; d < dim; ++d)
          inside = std::min({inside,
                             body.position(i)[d] - body.scene.domain.lower[d],
                             body.scene.domain.upper[d] - body.position(i)[d]});
        for (unsigned int d = 0; inside > 2.1 * reach && d < dim; ++d)
          EXPECT_NEAR(forces.local_element(dim * i + d), 0., 1e-13);
      }
  }
} // namespace


TEST(YieldingFamilies, slopes_2D)
{
  for (const Kind &kind : kinds<2>())
    expect_slopes<2>(kind);
}


TEST(YieldingFamilies, slopes_3D)
{
  for (const Kind &kind : kinds<3>())
    expect_slopes<3>(kind);
}


TEST(YieldingFamilies, uniform_strain_of_complete_families)
{
  expect_uniform<2>({{"Elasticity/Plane", "strain"}});
  expect_uniform<2>({{"Elasticity/Plane", "stress"}});
  expect_uniform<3>({});
}


TEST(YieldingFamilies, below_the_yield_stress_the_linear_solid)
{
  const Settings stored{{"Peridynamics/Operator form", "stored"}};
  for (const Kind &kind : kinds<2>())
    {
      if (std::string(kind.name) == "plane stress, phases")
        continue;
      SCOPED_TRACE(kind.name);
      const Settings high{{"Material/Yield stress", "100"}};
      Body<2>        linear(box<2>() + kind.more + stored, ModelKind::peridynamics),
        body(box<2>() + plastic + kind.more + high, ModelKind::peridynamics);
      const Vector u = waves(body, 0.05, 0.);
      Vector       a(u), b(u);
      linear.op().unbalanced(a, u, 0.);
      body.op().unbalanced(b, u, 0.);
      EXPECT_LT(worst_difference(a, b), 1e-12 * a.linfty_norm());
      EXPECT_NEAR(linear.op().energy(u), body.op().energy(u), 1e-12 * linear.op().energy(u));
      body.op().accept(waves(body, 0.02, 0.), 0.);
      body.op().accept(u, 1.);
      EXPECT_EQ(body.op().released().by_law, 0.);
      linear.op().linearize(u);
      body.op().linearize(u);
      EXPECT_LT(worst_difference(linear.product(u), body.product(u)), 1e-13 * a.linfty_norm());
    }
}


TEST(YieldingFamilies, what_a_step_dissipates)
{
  // By steps that are half as long the work of the mean force comes nearer to that of the yield
  // stress, and what trials did is forgotten.
  std::vector<double> excess;
  for (const unsigned int n : {20, 40, 80})
    {
      Body<2> body(box<2>() + plastic + kinds<2>()[1].more, ModelKind::peridynamics);
      double  work = 0., stored = 0., by_forces = 0.;
      Vector  last = waves(body, 0., 0.), now(last), before(last), forces(last);
      body.op().unbalanced(before, last, 0.);
      body.op().accept(last, 0.);
      for (unsigned int k = 1; k <= n; ++k)
        {
          const double s = 1. * k / n;
          now            = waves(body, 0.1 * s * (1.5 - s), 0.3);
          if (k % 7 == 0)
            body.op().energy(waves(body, 0.3, 1.));
          work += yielding(body).plastic_work(now);
          body.op().unbalanced(forces, now, s);
          for (unsigned int i = 0; i < now.locally_owned_size(); ++i)
            by_forces -= 0.5 * (forces.local_element(i) + before.local_element(i)) *
                         (now.local_element(i) - last.local_element(i));
          before = forces;
          last   = now;
          body.op().accept(now, s);
          stored = body.op().energy(now);
        }
      by_forces               = dealii::Utilities::MPI::sum(by_forces, MPI_COMM_WORLD);
      const double dissipated = body.op().released().by_law;
      EXPECT_NEAR(by_forces, stored + dissipated, 1e-12 * by_forces);
      EXPECT_GT(dissipated, 0.3 * by_forces);
      excess.push_back(dissipated / work - 1.);
    }
  EXPECT_LT(std::abs(excess[2]), 2e-3);
  EXPECT_LT(std::abs(excess[2]), 0.4 * std::abs(excess[1]));
  EXPECT_LT(std::abs(excess[1]), 0.4 * std::abs(excess[0]));
}


TEST(YieldingFamilies, archived_and_taken_up_again)
{
  const Settings settings = box<2>() + plastic + kinds<2>()[2].more;
  Body<2> body(settings, ModelKind::peridynamics), resumed(settings, ModelKind::peridynamics);
  body.op().accept(waves(body, 0.05, 0.), 0.);
  body.op().accept(waves(body, 0.06, 0.5), 1.);
  MemoryArchive saved(MPI_COMM_WORLD);
  body.op().exchange(saved, keys_of(body));
  MemoryArchive loaded(saved, MPI_COMM_WORLD);
  resumed.op().exchange(loaded, keys_of(resumed));
  const Vector u = waves(body, 0.07, 0.6);
  Vector       a(u), b(u);
  body.op().unbalanced(a, u, 2.);
  resumed.op().unbalanced(b, u, 2.);
  EXPECT_EQ(worst_difference(a, b), 0.);
  body.op().accept(u, 2.);
  resumed.op().accept(u, 2.);
  EXPECT_EQ(body.op().released().by_law, resumed.op().released().by_law);
  for (unsigned int i = 0; i < body.n_owned(); ++i)
    EXPECT_EQ(yielding(body).plastic_strain(i), yielding(resumed).plastic_strain(i));
}


TEST(YieldingFamilies, same_on_every_number_of_processes)
{
  for (const unsigned int k : {1, 2, 4})
    {
      const Settings settings = box<2>() + plastic + kinds<2>()[k].more;
      Body<2>        body(settings, ModelKind::peridynamics),
        whole(settings, ModelKind::peridynamics, MPI_COMM_SELF);
      SCOPED_TRACE(kinds<2>()[k].name);
      Vector     forces = body.vector(), of_whole = whole.vector();
      const auto compare = [&](const bool to_the_last_bit) {
        for_each_pair(body, whole, [&](const unsigned int i, const unsigned int n) {
          for (unsigned int d = 0; d < 2; ++d)
            EXPECT_NEAR(forces.local_element(2 * i + d),
                        of_whole.local_element(2 * n + d),
                        to_the_last_bit ? 0. : 1e-13);
          EXPECT_NEAR(yielding(body).plastic_strain(i),
                      yielding(whole).plastic_strain(n),
                      to_the_last_bit ? 0. : 1e-14);
        });
      };
      for (const double phase : {0.1, 0.4, 0.5})
        {
          body.op().unbalanced(forces, waves(body, 0.06, phase), phase);
          whole.op().unbalanced(of_whole, waves(whole, 0.06, phase), phase);
          // Forces of fictitious nodes are passed on in another order.
          compare(k == 4);
          body.op().accept(waves(body, 0.06, phase), phase);
          whole.op().accept(waves(whole, 0.06, phase), phase);
        }
      body.op().linearize(waves(body, 0.08, 0.7));
      whole.op().linearize(waves(whole, 0.08, 0.7));
      body.op().multiply(forces, waves(body, 1., 3.));
      whole.op().multiply(of_whole, waves(whole, 1., 3.));
      for_each_pair(body, whole, [&](const unsigned int i, const unsigned int n) {
        for (unsigned int d = 0; d < 2; ++d)
          EXPECT_NEAR(forces.local_element(2 * i + d),
                      of_whole.local_element(2 * n + d),
                      1e-12 * whole.scene.material.moduli(Point<2>()).shear);
      });
      EXPECT_NEAR(body.op().released().by_law,
                  whole.op().released().by_law,
                  1e-12 * whole.op().released().by_law);
    }
}
