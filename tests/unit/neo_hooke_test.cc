// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Large deformations: the neo-Hookean law at a point against closed forms and the linear law, in
// finite elements and correspondence forces, tangents, rotations, uniform deformations, bodies on
// any number of processes.

#include <perideal/laws/elasticity.h>
#include <perideal/laws/linear_stress.h>
#include <perideal/laws/neo_hooke.h>
#include <perideal/solvers/linear_solver.h>

#include <cmath>
#include <random>

#include "dimensions.h"
#include "elastic_test_tools.h"
#include "newton_steps.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;
using dealii::Point;
using dealii::SymmetricTensor;
using dealii::Tensor;

namespace
{
  using Strain = StressLaw::Tensor;

  const StressState kinds[] = {StressState::three_dimensional, StressState::plane_stress};

  Moduli moduli_of(const double poisson)
  {
    return moduli_from(Modulus::young, 3., Modulus::poisson, poisson);
  }


  StressLaw::Response look(const StressState   kind,
                           const Moduli       &moduli,
                           const Strain       &strain,
                           StressLaw::Tangent *tangent = nullptr)
  {
    const double parameters[2] = {moduli.bulk, moduli.shear};
    return NeoHooke(kind).update({strain, parameters, nullptr}, nullptr, tangent);
  }


  /** Of a body whose principal stretches are up to two and down to a half. */
  Strain some_strain(std::mt19937 &generator, const StressState kind)
  {
    std::uniform_real_distribution<double> number(-0.3, 0.3);
    Tensor<2, 3>                           F;
    for (unsigned int a = 0; a < 3; ++a)
      for (unsigned int b = 0; b < 3; ++b)
        F[a][b] = kind == StressState::plane_stress && std::max(a, b) == 2 ? 0. : number(generator);
    return symmetrize(F) + 0.5 * symmetrize(transpose(F) * F);
  }


  TEST(NeoHooke, slopes_of_the_energy_and_of_stresses)
  {
    std::mt19937 generator(1);
    const double h = 1e-6;
    for (const StressState kind : kinds)
      for (const double poisson : {-0.3, 0.3, 0.499})
        for (unsigned int n = 0; n < 20; ++n)
          {
            const Moduli       moduli = moduli_of(poisson);
            const Strain       strain = some_strain(generator, kind);
            StressLaw::Tangent tangent;
            const auto         response = look(kind, moduli, strain, &tangent);
            for (unsigned int k = 0; k < 6; ++k)
              if (kind == StressState::three_dimensional || k < 2 || k == 3)
                {
                  Strain up = strain, down = strain, unit;
                  up.access_raw_entry(k) += h;
                  down.access_raw_entry(k) -= h;
                  unit.access_raw_entry(k) = 1.;
                  const auto   above = look(kind, moduli, up), below = look(kind, moduli, down);
                  const double slope = (above.stored - below.stored) / (2. * h);
                  EXPECT_NEAR(slope, response.stress * unit, 1e-7 * (1. + std::abs(slope)));
                  EXPECT_LT(((above.stress - below.stress) / (2. * h) - tangent * unit).norm(),
                            1e-6 * tangent.norm());
                }
            EXPECT_GT(response.stored, 0.);
          }
  }


  /** The linear law. Second terms have the bulk modulus: where it is large strains are smaller. */
  TEST(NeoHooke, small_strains)
  {
    std::mt19937 generator(2);
    for (const StressState kind : kinds)
      for (const double poisson : {-0.3, 0.3, 0.499})
        for (unsigned int n = 0; n < 20; ++n)
          {
            const Moduli moduli   = moduli_of(poisson);
            const Strain strain   = (poisson > 0.4 ? 1e-9 : 1e-7) * some_strain(generator, kind);
            const Strain expected = isotropic_stiffness(moduli, kind) * strain;
            const auto   response = look(kind, moduli, strain);
            EXPECT_LT((response.stress - expected).norm(), 1e-6 * expected.norm());
            EXPECT_NEAR(response.stored, 0.5 * (expected * strain), 1e-6 * response.stored);
            StressLaw::Tangent tangent;
            look(kind, moduli, Strain(), &tangent);
            EXPECT_LT((tangent - isotropic_stiffness(moduli, kind)).norm(), 1e-13 * tangent.norm());
          }
  }


  /** They differ by G J^(-5/3) times the differences of squares, their mean is K/2 (J - 1/J). */
  TEST(NeoHooke, principal_stresses)
  {
    for (const StressState kind : kinds)
      {
        const Moduli moduli       = moduli_of(0.4);
        double       stretches[3] = {1.5, 0.8, 1.1};
        Strain       strain;
        for (unsigned int a = 0; a < 3; ++a)
          strain[a][a] = 0.5 * (stretches[a] * stretches[a] - 1.);
        const auto response = look(kind, moduli, strain);
        if (kind == StressState::plane_stress)
          stretches[2] = response.stretch;
        const double J = stretches[0] * stretches[1] * stretches[2];
        double       stresses[3];
        for (unsigned int a = 0; a < 3; ++a)
          stresses[a] = stretches[a] * stretches[a] * response.stress[a][a] / J;
        for (unsigned int a = 0; a < 3; ++a)
          EXPECT_NEAR(stresses[a] - stresses[2],
                      moduli.shear * std::pow(J, -5. / 3.) *
                        (stretches[a] * stretches[a] - stretches[2] * stretches[2]),
                      1e-13);
        EXPECT_NEAR(stresses[0] + stresses[1] + stresses[2],
                    1.5 * moduli.bulk * (J - 1. / J),
                    1e-12);
      }
  }


  const Settings rubber{{"Material/Law", "hyperelastic"},
                        {"Elasticity/Kinematics", "full"},
                        {"Elasticity/Solver", "newton"}};
  const Settings nodal{{"Elasticity/Model", "correspondence"}, {"Peridynamics/Horizon ratio", "2"}};

  struct Kind
  {
    const char     *name;
    const ModelKind model;
    Settings        more;
  };

  template <int dim>
  std::vector<Kind> bodies()
  {
    const auto     elements = ModelKind::finite_elements;
    const Settings few{{"Domain/Cells", dim == 3 ? "3, 2, 2" : "6, 4"}},
      quadratic{{"Finite elements/Degree", "2"}}, linear{{"Material/Law", "linear"}},
      hard{{"Material/Poisson ratio", "0.49"}};
    if (dim == 3)
      return {{"3D", elements, few},
              {"3D, quadratic", elements, Settings{{"Domain/Cells", "1, 1, 1"}} + quadratic + hard},
              {"3D, linear law", elements, few + linear},
              {"3D, nodes", ModelKind::peridynamics, few + nodal}};
    const Settings strain{{"Elasticity/Plane", "strain"}}, stress{{"Elasticity/Plane", "stress"}},
      phases{{"Material/Young modulus", "3 + y"}};
    return {
      {"plane strain", elements, few + strain + hard},
      {"plane strain, quadratic", elements, few + strain + quadratic + hard},
      {"plane strain, linear law", elements, few + strain + linear},
      {"plane stress, phases", elements, few + stress + phases},
      {"plane strain, nodes", ModelKind::peridynamics, few + strain + nodal},
      {"plane stress, nodes, phases", ModelKind::peridynamics, few + stress + nodal + phases}};
  }


  /** Not far from a body that is stretched, sheared and turned. */
  template <int dim>
  Vector deformed(const Body<dim> &body, const double bumps = 0.02)
  {
    return body.values([&](const Point<dim> &p) {
      return Tensor<1, dim>(linear_field<dim>(p) + bumps * bumpy_vector<dim>(p));
    });
  }


  template <int dim>
  Tensor<2, dim> rotation(const double angle)
  {
    Tensor<2, dim> r;
    r[dim - 1][dim - 1] = 1.;
    r[0][0] = r[1][1] = std::cos(angle);
    r[0][1]           = -std::sin(angle);
    r[1][0]           = std::sin(angle);
    return r;
  }


  TEST_IN_DIMENSIONS(LargeDeformations, forces_are_slopes_and_tangents_are_theirs, 2, 3)
  {
    for (const Kind &kind : bodies<dim>())
      {
        SCOPED_TRACE(kind.name);
        const Body<dim> body(box<dim>() + rubber + kind.more, kind.model);
        const Vector    u = deformed(body);
        body.op().linearize(u);
        expect_derivatives(body, u, body.product(body.values(bumpy_vector<dim>)), 1e-6, 1e-6, 1e-6);
      }
  }


  /** A rotation makes no force, and turns those of a deformed body. */
  TEST_IN_DIMENSIONS(LargeDeformations, rotations, 2, 3)
  {
    for (const Kind &kind : bodies<dim>())
      {
        SCOPED_TRACE(kind.name);
        const Body<dim>      body(box<dim>() + rubber + kind.more, kind.model);
        const Tensor<2, dim> turn = rotation<dim>(std::acos(-1.) / 6.);
        const Vector         u = deformed(body), forces = body.unbalanced(u),
                     turned = body.unbalanced(body.values([&](const Point<dim> &p) {
                       const Tensor<1, dim> moved =
                         linear_field<dim>(p) + 0.02 * bumpy_vector<dim>(p);
                       return Tensor<1, dim>(turn * (p + moved) - p);
                     })),
                     rigid  = body.values(
                       [&](const Point<dim> &p) { return Tensor<1, dim>(turn * p - p); });
        double gap = 0.;
        for (unsigned int i = 0; i < body.n_owned(); ++i)
          {
            Tensor<1, dim> before, now;
            for (unsigned int d = 0; d < dim; ++d)
              {
                before[d] = forces.local_element(dim * i + d);
                now[d]    = turned.local_element(dim * i + d);
              }
            gap = std::max(gap, (now - turn * before).norm());
          }
        EXPECT_LT(gap, 1e-12 * forces.linfty_norm());
        EXPECT_LT(body.unbalanced(rigid).linfty_norm(), 1e-13);
        EXPECT_LT(body.op().energy(rigid), 1e-24);
      }
  }


  /** Energies of uniform deformations are those of a point. */
  TEST_IN_DIMENSIONS(LargeDeformations, uniform_deformations, 2, 3)
  {
    for (const Kind &kind : bodies<dim>())
      {
        const Body<dim> body(box<dim>() + rubber + kind.more, kind.model);
        if (!body.scene.material.uniform_moduli() ||
            body.scene.material.law.kind == SolidLaw::linear)
          continue;
        SCOPED_TRACE(kind.name);
        const auto                    G       = some_gradient<dim>();
        const SymmetricTensor<2, dim> in_body = symmetrize(G) + 0.5 * symmetrize(transpose(G) * G);
        Strain                        strain;
        double                        volume = 1.;
        for (unsigned int a = 0; a < dim; ++a)
          {
            volume *= body.scene.domain.upper[a];
            for (unsigned int b = a; b < dim; ++b)
              strain[a][b] = in_body[a][b];
          }
        const double stored = look(stress_state_of(dim, body.scene.elasticity.plane),
                                   body.scene.material.moduli(Point<dim>()),
                                   strain)
                                .stored;
        EXPECT_NEAR(body.op().energy(deformed(body, 0.)), volume * stored, 1e-12 * stored);
      }
  }


  TEST_IN_DIMENSIONS(LargeDeformations, same_on_every_number_of_processes, 2, 3)
  {
    for (const Kind &kind : bodies<dim>())
      {
        SCOPED_TRACE(kind.name);
        const Body<dim> body(box<dim>() + rubber + kind.more, kind.model),
          alone(box<dim>() + rubber + kind.more, kind.model, MPI_COMM_SELF);
        const Vector forces = body.unbalanced(deformed(body)),
                     whole  = alone.unbalanced(deformed(alone));
        EXPECT_LT(difference(body, forces, alone, whole), 1e-12 * whole.linfty_norm());
        const double energy = alone.op().energy(deformed(alone));
        EXPECT_NEAR(body.op().energy(deformed(body)), energy, 1e-12 * energy);
      }
  }


  /** Once residuals are small each is as the square of the one before. */
  TEST(LargeDeformations, newtons_method)
  {
    for (const Kind &kind : bodies<2>())
      {
        SCOPED_TRACE(kind.name);
        const Settings   load{{"Boundary conditions/Traction", "right: 0.15, 0.02"}};
        const Body<2>    body(box<2>() + rubber + kind.more + load, kind.model);
        ElasticOperator &op    = body.op();
        const auto       sizes = residuals_of_newton(op, body.vector(), 1e-11);
        EXPECT_LT(sizes.back(), 1e-11 * sizes[0]);
        EXPECT_GT(sizes.size(), 4u);
        for (unsigned int n = 1; n + 1 < sizes.size(); ++n)
          if (sizes[n] < 0.1 * sizes[0])
            {
              const double before = sizes[n] / sizes[0], now = sizes[n + 1] / sizes[0];
              EXPECT_LT(now, 30. * before * before + 1e-11) << n;
            }
      }
  }


  /** What is inside out is told by all processes, with the place. */
  TEST(LargeDeformations, bodies_that_are_inside_out)
  {
    for (const Kind &kind : bodies<2>())
      {
        SCOPED_TRACE(kind.name);
        const Body<2> body(box<2>() + rubber + kind.more, kind.model);
        const Vector  u = body.values([](const Point<2> &p) {
          Tensor<1, 2> moved;
          moved[0] = p[0] > 0.9 ? -0.5 : 0.;
          return moved;
        });
        std::string   words, place;
        try
          {
            body.unbalanced(u);
          }
        catch (const Diverged &failure)
          {
            words = failure.message();
            EXPECT_EQ(failure.trip.monitor, "inversion");
            EXPECT_EQ(failure.trip.place.size(), 2u);
            EXPECT_GT(failure.trip.place[0], 0.7);
          }
        EXPECT_NE(words.find("inside out at ("), std::string::npos) << words;
        EXPECT_NE(words.find("'Time step'"), std::string::npos) << words;
      }
  }
} // namespace
