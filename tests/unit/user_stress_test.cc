// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Laws of users (UMAT): under large deformations at a point, a neo-Hookean one against the built-in
// law, its tangent against differences, a hypoelastic one that turns with the body, energies; in
// bodies the same, and Newton's method with a tangent that is not symmetric.

#include <perideal/laws/finite_strain.h>
#include <perideal/laws/neo_hooke.h>
#include <perideal/laws/user_stress.h>
#include <perideal/solvers/linear_solver.h>

#include <dlfcn.h>

#include <array>
#include <cmath>
#include <random>

#include "dimensions.h"
#include "elastic_test_tools.h"
#include "newton_steps.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;
using dealii::Point;
using dealii::Tensor;

namespace
{
  using Strain   = StressLaw::Tensor;
  using Gradient = Tensor<2, 3>;

  constexpr double       bulk = 5., shear = 1.2;
  constexpr unsigned int ends[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

  const Gradient one(dealii::unit_symmetric_tensor<3>());


  /** What a umat_ gets that counts here. */
  struct Told
  {
    double       *stress, *tangent;
    const double *strain, *change, *rotation, *before, *now;
    double       *stored, *spent;
    const double *temperature, *warming;
  };

  using Law = void (*)(const Told &);


  /** The law as a umat_. */
  template <Law law>
  void as_umat(double *stress,
               double *,
               double *tangent,
               double *stored,
               double *spent,
               double *,
               double *,
               double *,
               double *,
               double *,
               double *strain,
               double *change,
               double *,
               double *,
               double *temperature,
               double *warming,
               double *,
               double *,
               char *,
               int *,
               int *,
               int *,
               int *,
               double *,
               int *,
               double *,
               double *rotation,
               double *,
               double *,
               double *before,
               double *now,
               int *,
               int *,
               int *,
               int *,
               int *,
               int *,
               std::size_t)
  {
    law({stress,
         tangent,
         strain,
         change,
         rotation,
         before,
         now,
         stored,
         spent,
         temperature,
         warming});
  }


  Gradient of_columns(const double *const list)
  {
    Gradient a;
    for (unsigned int k = 0; k < 9; ++k)
      a[k % 3][k / 3] = list[k];
    return a;
  }


  /** NeoHooke, as it is written in the deformed body. */
  void neo_hookean(const Told &told)
  {
    const Gradient F      = of_columns(told.now);
    const double   J      = determinant(F);
    const Strain   b      = std::pow(J, -2. / 3.) * symmetrize(F * transpose(F));
    const auto     I      = dealii::unit_symmetric_tensor<3>();
    const Strain   cauchy = shear / J * deviator(b) + 0.5 * bulk * (J - 1. / J) * I;
    for (unsigned int p = 0; p < 6; ++p)
      {
        const auto &[i, j] = ends[p];
        told.stress[p]     = cauchy[i][j];
        for (unsigned int q = 0; q < 6; ++q)
          {
            const auto &[k, l]      = ends[q];
            told.tangent[p + 6 * q] = shear / J *
                                        (0.5 * (I[i][k] * b[j][l] + b[i][k] * I[j][l] +
                                                I[i][l] * b[j][k] + b[i][l] * I[j][k]) -
                                         2. / 3. * (I[i][j] * b[k][l] + b[i][j] * I[k][l]) +
                                         2. / 9. * trace(b) * I[i][j] * I[k][l]) +
                                      bulk * J * I[i][j] * I[k][l];
          }
      }
    *told.stored =
      (0.5 * shear * (trace(b) - 3.) + 0.5 * bulk * (0.5 * (J * J - 1.) - std::log(J))) / J;
  }


  struct
  {
    Gradient rotation, before, now;
  } last_told;

  /** Linear in DSTRAN. */
  void hypoelastic(const Told &told)
  {
    last_told = {of_columns(told.rotation), of_columns(told.before), of_columns(told.now)};
    const double lambda = bulk - 2. / 3. * shear;
    double       sum    = 0.;
    for (unsigned int k = 0; k < 3; ++k)
      sum += told.change[k];
    for (unsigned int k = 0; k < 6; ++k)
      {
        told.stress[k] +=
          (k < 3 ? lambda * sum + 2. * shear * told.change[k] : shear * told.change[k]);
        for (unsigned int l = 0; l < 6; ++l)
          told.tangent[k + 6 * l] = (k < 3 && l < 3 ? lambda : 0.) + (k != l ? 0. :
                                                                      k < 3  ? 2. * shear :
                                                                               shear);
      }
  }


  /** Tells temperatures. */
  void tells_temperatures(const Told &told)
  {
    told.stress[0] = *told.temperature;
    told.stress[1] = *told.warming;
  }


  /** Not the derivative of anything; its entry of row 1 and column 2 is not that across. */
  void one_sided(const Told &told)
  {
    hypoelastic(told);
    told.tangent[6] = 3.; // of STRESS(1) by DSTRAN(2)
  }


  struct PointOfBody
  {
    explicit PointOfBody(const Umat umat)
      : law(std::make_shared<const UserLibrary>(dlopen(nullptr, RTLD_NOW), umat, nullptr, 0, "law"),
            3,
            StressState::three_dimensional,
            {0, {{"MATERIAL", {}}}},
            true)
      , state(law.n_state(), 0.)
      , next(state)
    {}

    StressLaw::Response look(const Gradient &F, StressLaw::Tangent *tangent = nullptr)
    {
      StressLaw::Trial trial{Strain(), parameters.data(), state.data()};
      trial.time                  = 1.;
      trial.step                  = 1.;
      trial.displacement_gradient = F - one;
      return law.update(trial, next.data(), tangent);
    }

    StressLaw::Response go(const Gradient &F)
    {
      const auto response = look(F);
      state               = next;
      dissipated += response.dissipated;
      return response;
    }

    const UserStress            law;
    const std::array<double, 4> parameters{};
    std::vector<double>         state, next;
    double                      dissipated = 0.;
  };


  Gradient some_gradient(std::mt19937 &generator, const double size)
  {
    std::uniform_real_distribution<double> number(-size, size);
    Gradient                               F = one;
    for (unsigned int a = 0; a < 3; ++a)
      for (unsigned int b = 0; b < 3; ++b)
        F[a][b] += number(generator);
    return F;
  }


  /** About z, then about x. */
  Gradient rotation(const double angle)
  {
    Gradient about_z = one, about_x = one;
    about_z[0][0] = about_z[1][1] = about_x[1][1] = about_x[2][2] = std::cos(angle);
    about_z[1][0] = about_x[2][1] = std::sin(angle);
    about_z[0][1] = about_x[1][2] = -std::sin(angle);
    return about_x * about_z;
  }


  Strain cauchy_of(const Gradient &F, const StressLaw::Response &response)
  {
    return symmetrize(F * Gradient(response.stress) * transpose(F)) / determinant(F);
  }


  TEST(UserStress, steps_are_rotations_and_logarithms_of_stretches)
  {
    std::mt19937 generator(1);
    for (const double size : {0.3, 1e-3, 1e-9, 0.})
      for (unsigned int n = 0; n < 20; ++n)
        {
          const Gradient before = some_gradient(generator, 0.3),
                         f = some_gradient(generator, size) * rotation(0.3 * n), now = f * before;
          const FiniteStep step(before - one, now - one);
          EXPECT_LT((step.rotation * transpose(step.rotation) - one).norm(), 1e-14);
          // exp(ln V), by its series
          Gradient power = one, V = one;
          for (unsigned int k = 1; k < 40; ++k)
            {
              power = 1. / k * (Gradient(step.stretch) * power);
              V += power;
            }
          EXPECT_LT((V * step.rotation - f).norm(), 2e-14);
        }
    Strain stretch;
    stretch[0][0] = 1e-9;
    stretch[1][2] = -3e-9;
    const Gradient F =
      Gradient(stretch) + Gradient(0.5 * symmetrize(Gradient(stretch) * Gradient(stretch)));
    EXPECT_LT((FiniteStep(Gradient(), F).stretch - stretch).norm(), 1e-15 * stretch.norm() + 1e-24);
  }


  TEST(UserStress, neo_hookean_law)
  {
    std::mt19937 generator(2);
    PointOfBody  point(as_umat<neo_hookean>);
    const double h = 1e-6, parameters[2] = {bulk, shear};
    for (unsigned int n = 0; n < 30; ++n)
      {
        const Gradient     F = rotation(0.4 * n) * some_gradient(generator, 0.3);
        const Strain       E = green_strain(F - one);
        StressLaw::Tangent tangent, expected;
        const auto         response = point.look(F, &tangent);
        const auto         built_in = NeoHooke(StressState::three_dimensional)
                                .update({E, parameters, nullptr}, nullptr, &expected);
        EXPECT_LT((response.stress - built_in.stress).norm(), 1e-12 * built_in.stress.norm());
        EXPECT_NEAR(response.stored, built_in.stored, 1e-12 * built_in.stored);
        EXPECT_LT((tangent - expected).norm(), 1e-12 * expected.norm());
        EXPECT_TRUE(response.has_symmetric_tangent);
        for (unsigned int k = 0; k < 6; ++k)
          {
            Strain unit;
            unit.access_raw_entry(k) = 1.;
            const Gradient along     = transpose(invert(F)) * Gradient(unit);
            const Strain   difference =
              (point.look(F + h * along).stress - point.look(F - h * along).stress) / (2. * h);
            EXPECT_LT((tangent * unit - difference).norm(), 1e-6 * expected.norm());
          }
        point.go(F);
      }
    EXPECT_EQ(point.dissipated, 0.);
  }


  /** By parts of a turn of 90 degrees while the body's own stretches grow: sigma = C : ln V. */
  TEST(UserStress, hypoelastic_law_turns_with_the_body)
  {
    for (const unsigned int n_steps : {1u, 7u, 50u})
      {
        PointOfBody point(as_umat<hypoelastic>);
        Strain      logarithm, strain;
        Gradient    turn, turn_before;
        logarithm[0][0] = std::log(1.5);
        logarithm[1][1] = std::log(0.8);
        logarithm[2][2] = std::log(1.1);
        StressLaw::Response last;
        Gradient            F;
        for (unsigned int n = 1; n <= n_steps; ++n)
          {
            const double at = 1. * n / n_steps;
            Gradient     U;
            for (unsigned int d = 0; d < 3; ++d)
              U[d][d] = std::exp(at * logarithm[d][d]);
            turn                  = rotation(std::acos(0.) * at);
            const Gradient before = n == 1 ? one : F, turned = n == 1 ? one : turn_before;
            F    = turn * U;
            last = point.go(F);
            EXPECT_LT((last_told.rotation - turn * transpose(turned)).norm(), 1e-14);
            EXPECT_LT((last_told.before - before).norm() + (last_told.now - F).norm(), 1e-14);
            turn_before = turn;
          }
        const auto carried = [&](const Strain &a) {
          return symmetrize(turn * Gradient(a) * transpose(turn));
        };
        const Strain expected =
          carried(2. * shear * logarithm +
                  (bulk - 2. / 3. * shear) * trace(logarithm) * dealii::unit_symmetric_tensor<3>());
        EXPECT_LT((cauchy_of(F, last) - expected).norm(), 1e-13 * expected.norm()) << n_steps;
        for (unsigned int k = 0; k < 6; ++k) // STRAN
          EXPECT_NEAR(point.state[k] / (k < 3 ? 1. : 2.),
                      carried(logarithm)[ends[k][0]][ends[k][1]],
                      1e-14);
        // A turn alone leaves S as it is.
        const Strain second = last.stress;
        EXPECT_LT((point.go(rotation(1.) * F).stress - second).norm(), 1e-13 * second.norm());
      }
  }


  /** Simple shear by Jaumann's rate: 2 x shear/2 sin, of second order in the step. */
  TEST(UserStress, simple_shear)
  {
    double errors[2];
    for (unsigned int k = 0; k < 2; ++k)
      {
        PointOfBody        point(as_umat<hypoelastic>);
        const unsigned int n_steps = 20u << k;
        Gradient           F       = one;
        Strain             cauchy;
        for (unsigned int n = 1; n <= n_steps; ++n)
          {
            F[0][1] = 1.5 * n / n_steps;
            cauchy  = cauchy_of(F, point.go(F));
          }
        errors[k] = std::max(std::abs(cauchy[0][1] - shear * std::sin(1.5)),
                             std::abs(cauchy[0][0] - shear * (1. - std::cos(1.5))));
      }
    EXPECT_LT(errors[0], 1e-3 * shear);
    EXPECT_NEAR(errors[0] / errors[1], 4., 0.2);
  }


  /** TEMP is that of the accepted step. */
  TEST(UserStress, temperatures)
  {
    PointOfBody      point(as_umat<tells_temperatures>);
    StressLaw::Trial trial{Strain(), point.parameters.data(), point.state.data()};
    trial.step        = 1.;
    trial.temperature = 350.;
    trial.warming     = 50.;
    EXPECT_EQ((point.law.update(trial, point.next.data(), nullptr).stress[0][0]), 300.);
    EXPECT_EQ((point.law.update(trial, point.next.data(), nullptr).stress[1][1]), 50.);
  }


  /** What is not symmetric is kept, by rows and columns; small differences are halved. */
  TEST(UserStress, unsymmetric_tangents)
  {
    PointOfBody        point(as_umat<one_sided>);
    StressLaw::Tangent tangent;
    EXPECT_FALSE(point.look(one, &tangent).has_symmetric_tangent);
    EXPECT_EQ((tangent[0][0][1][1]), 3.);
    EXPECT_NEAR((tangent[1][1][0][0]), bulk - 2. / 3. * shear, 1e-15);
    EXPECT_TRUE(point.look(one).has_symmetric_tangent); // nobody asked
  }


  /** Where the law gives none all work of the mean stresses is stored, of second order. */
  TEST(UserStress, work)
  {
    double gaps[2];
    for (unsigned int k = 0; k < 2; ++k)
      {
        PointOfBody         point(as_umat<hypoelastic>);
        const unsigned int  n_steps = 10u << k;
        StressLaw::Response last;
        for (unsigned int n = 1; n <= n_steps; ++n)
          {
            Gradient F = one;
            F[0][0]    = 1. + 0.5 * n / n_steps;
            last       = point.go(F);
          }
        // the integral of (lambda + 2 G) ln x from 1 to 1.5
        gaps[k] = last.stored - (bulk + 4. / 3. * shear) * (1.5 * std::log(1.5) - 0.5);
      }
    EXPECT_LT(std::abs(gaps[0]), 2e-3);
    EXPECT_NEAR(gaps[0] / gaps[1], 4., 0.1);
  }


  /** A law of tests/umats in place of moduli. */
  Settings with_law(const std::string &name,
                    const std::string &properties,
                    const std::string &states)
  {
    return {{"Material/Law", "user"},
            {"Material/Young modulus", ""},
            {"Material/Poisson ratio", ""},
            {"Material/User law", std::string(PERIDEAL_SOURCE_DIR) + "/tests/umats/" + name},
            {"Material/User properties", properties},
            {"Material/User states", states},
            {"Elasticity/Solver", "newton"}};
  }

  const Settings full{{"Elasticity/Kinematics", "full"}},
    nodal{{"Elasticity/Model", "correspondence"}, {"Peridynamics/Horizon ratio", "2"}};

  template <int dim>
  Settings few()
  {
    Settings settings = box<dim>() + Settings{{"Domain/Cells", dim == 3 ? "3, 2, 2" : "6, 4"}};
    return dim == 3 ? settings : settings + Settings{{"Elasticity/Plane", "strain"}};
  }


  TEST_IN_DIMENSIONS(UserStressBodies, neo_hookean_bodies, 2, 3)
  {
    const Settings built_in{{"Material/Young modulus", ""},
                            {"Material/Poisson ratio", ""},
                            {"Material/Bulk modulus", "5"},
                            {"Material/Shear modulus", "1.2"},
                            {"Material/Law", "hyperelastic"},
                            {"Elasticity/Solver", "newton"}};
    for (const ModelKind model : {ModelKind::finite_elements, ModelKind::peridynamics})
      {
        const Settings all =
          few<dim>() + full + (model == ModelKind::peridynamics ? nodal : Settings());
        const Body<dim> body(all + with_law("neo_hooke.c", "5, 1.2", "0"), model),
          other(all + built_in, model);
        const Vector u      = body.values([](const Point<dim> &p) {
          return dealii::Tensor<1, dim>(linear_field<dim>(p) + 0.02 * bumpy_vector<dim>(p));
        });
        const Vector forces = body.unbalanced(u);
        Vector       gap    = other.unbalanced(u);
        const double size   = gap.linfty_norm();
        gap -= forces;
        EXPECT_LT(gap.linfty_norm(), 1e-12 * size);
        EXPECT_NEAR(body.op().energy(u), other.op().energy(u), 1e-12 * other.op().energy(u));
        body.op().linearize(u);
        EXPECT_TRUE(body.op().symmetric());
        expect_derivatives(body, u, body.product(body.values(bumpy_vector<dim>)), 1e-6, 1e-6, 1e-6);
      }
  }


  /** Once residuals are small each is as the square of the one before; GMRES finds the steps. */
  TEST(UserStressBodies, newtons_method_where_the_flow_is_not_associated)
  {
    const Settings law  = with_law("drucker_prager.c", "1000, 0.3, 1, 50, 0.4, 0.1", "1"),
                   load = {{"Boundary conditions/Traction", "right: -0.6, -0.5"}};
    struct
    {
      const char     *name;
      const ModelKind model;
      const Settings  more;
    } const kinds[] = {{"elements", ModelKind::finite_elements, {}},
                       {"nodes", ModelKind::peridynamics, nodal},
                       {"elements, large", ModelKind::finite_elements, full},
                       {"nodes, large", ModelKind::peridynamics, nodal + full}};
    for (const auto &[name, model, more] : kinds)
      {
        SCOPED_TRACE(name);
        const Body<2>    body(few<2>() + law + load + more, model);
        ElasticOperator &op = body.op();
        EXPECT_TRUE(op.symmetric());
        const auto sizes = residuals_of_newton(op, body.vector(), 1e-10);
        EXPECT_FALSE(op.symmetric());
        EXPECT_LT(sizes.back(), 1e-10 * sizes[0]);
        EXPECT_GT(sizes.size(), 4u);
        for (unsigned int n = 1; n + 1 < sizes.size(); ++n)
          if (sizes[n] < 1e-2 * sizes[0])
            {
              const double before = sizes[n] / sizes[0], now = sizes[n + 1] / sizes[0];
              EXPECT_LT(now, 100. * before * before + 1e-10) << n;
            }
      }
  }
} // namespace
