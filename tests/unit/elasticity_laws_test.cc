// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Laws of elasticity on paper: moduli, peridynamic solids against classical energies, stresses,
// critical stretches.

#include <deal.II/base/tensor.h>

#include <perideal/laws/elasticity.h>
#include <perideal/laws/entropy_of_deformation.h>
#include <perideal/laws/gauss_rule.h>
#include <perideal/laws/kernel.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

using namespace PeriDeal;
using dealii::SymmetricTensor;
using dealii::Tensor;

namespace
{
  const double pi = std::acos(-1.);

  const std::vector<double> poisson_ratios = {-0.5, 0., 0.2, 0.25, 1. / 3., 0.45, 0.49};


  Moduli young_and_poisson(const double E, const double nu)
  {
    return moduli_from(Modulus::young, E, Modulus::poisson, nu);
  }


  /**
   * Integral over all directions, exact for polynomials of degree 6; the weights sum to the area of
   * the unit sphere.
   */
  template <int dim>
  double over_directions(const std::function<double(const Tensor<1, dim> &)> &f)
  {
    const unsigned int n_angles = 16;
    const GaussRule    heights(8);
    double             sum = 0.;
    Tensor<1, dim>     n;
    if (dim == 1)
      {
        n[0] = 1.;
        return f(n) + f(-n);
      }
    for (unsigned int k = 0; k < n_angles; ++k)
      {
        const double angle = 2. * pi * (k + 0.3) / n_angles, weight = 2. * pi / n_angles;
        if (dim == 2)
          {
            n[0]       = std::cos(angle);
            n[dim - 1] = std::sin(angle);
            sum += weight * f(n);
            continue;
          }
        sum += heights.integrate(-1., 1., [&](const double z) {
          n[0]       = std::sqrt(1. - z * z) * std::cos(angle);
          n[1 % dim] = std::sqrt(1. - z * z) * std::sin(angle);
          n[dim - 1] = z;
          return weight * f(n);
        });
      }
    return sum;
  }


  /** Integral over the ball of radius delta. */
  template <int dim>
  double over_ball(const double delta, const std::function<double(const Tensor<1, dim> &)> &f)
  {
    const GaussRule radii(20);
    return radii.integrate(0., delta, [&](const double r) {
      return std::pow(r, dim - 1) *
             over_directions<dim>([&](const Tensor<1, dim> &n) { return f(r * n); });
    });
  }


  double omega(const double r, const double delta)
  {
    return kernel_shape(KernelShape::conical, r, delta) / r;
  }


  /**
   * 1/2 integral of t e under a uniform strain, and of a thermal strain that reduces the
   * extensions.
   */
  template <int dim>
  double bond_energy(const StateLaw                &law,
                     const SymmetricTensor<2, dim> &strain,
                     const double                   thermal = 0.)
  {
    const double delta = 0.7;
    const auto   e     = [&](const Tensor<1, dim> &xi) {
      return xi * (strain * xi) / xi.norm() - thermal * xi.norm();
    };
    const double q     = over_ball<dim>(delta, [&](const Tensor<1, dim> &xi) {
      return omega(xi.norm(), delta) * xi.norm_square();
    });
    const double theta = law.dilatation / q * over_ball<dim>(delta, [&](const Tensor<1, dim> &xi) {
                           return omega(xi.norm(), delta) * xi.norm() * e(xi);
                         });
    return 0.5 * over_ball<dim>(delta, [&](const Tensor<1, dim> &xi) {
             return omega(xi.norm(), delta) *
                    (law.volumetric / q * theta * xi.norm() + law.extension / q * e(xi)) * e(xi);
           });
  }


  template <int dim>
  std::vector<SymmetricTensor<2, dim>> some_strains()
  {
    std::vector<SymmetricTensor<2, dim>> strains(4);
    for (unsigned int d = 0; d < dim; ++d)
      strains[0][d][d] = 1e-3;
    strains[1][0][0]             = 2e-3;
    strains[2][0][dim - 1]       = -1e-3;
    strains[3][0][0]             = 1e-3;
    strains[3][dim - 1][dim - 1] = -3e-3;
    strains[3][0][dim - 1]       = 5e-4;
    return strains;
  }


  /**
   * Over all strains and Poisson ratios; the classical energy by Hooke's law in three dimensions.
   */
  template <int dim>
  void expect_classical_energy(const PlaneState plane)
  {
    for (const double nu : poisson_ratios)
      {
        const Moduli   moduli = young_and_poisson(210., nu);
        const StateLaw law    = state_law(moduli, dim, plane);
        for (const auto &strain : some_strains<dim>())
          {
            SymmetricTensor<2, 3> full;
            for (unsigned int i = 0; i < dim; ++i)
              for (unsigned int j = i; j < dim; ++j)
                full[i][j] = strain[i][j];
            // what the body does out of its plane
            if (dim == 1)
              full[1][1] = full[2][2] = -nu * full[0][0];
            if (dim == 2 && plane == PlaneState::stress)
              full[2][2] = -nu / (1. - nu) * (full[0][0] + full[1][1]);
            const double classical =
              0.5 * moduli.lambda() * trace(full) * trace(full) + moduli.shear * (full * full);
            EXPECT_NEAR(bond_energy<dim>(law, strain), classical, 1e-11 * classical)
              << "dim " << dim << ", nu " << nu;
            EXPECT_NEAR(0.5 * (stress<dim>(moduli, plane, strain) * strain),
                        classical,
                        1e-12 * classical);
          }
      }
  }
} // namespace


TEST(ElasticityLaws, moduli_of_all_pairs)
{
  for (const double nu : {-0.9, -0.3, 0., 0.3, 0.499})
    {
      const double               E = 70.;
      const std::vector<double>  values{E / (3. * (1. - 2. * nu)), E / (2. * (1. + nu)), E, nu};
      const std::vector<Modulus> names{Modulus::bulk,
                                       Modulus::shear,
                                       Modulus::young,
                                       Modulus::poisson};
      for (unsigned int i = 0; i < 4; ++i)
        for (unsigned int j = 0; j < 4; ++j)
          {
            if (i == j)
              continue;
            const Moduli moduli = moduli_from(names[i], values[i], names[j], values[j]);
            const double slack  = 1e-11; // 1 - 2 nu and 3 G - E have three digits less
            EXPECT_NEAR(moduli.bulk / values[0], 1., slack) << i << ' ' << j << ' ' << nu;
            EXPECT_NEAR(moduli.shear / values[1], 1., slack) << i << ' ' << j << ' ' << nu;
            EXPECT_NEAR(moduli.young() / E, 1., slack);
            EXPECT_NEAR(moduli.poisson(), nu, 1e-13);
            EXPECT_NEAR(moduli.lambda(), E * nu / ((1. + nu) * (1. - 2. * nu)), slack * values[0]);
            EXPECT_NEAR(poisson_from(names[i], values[i], names[j], values[j]), nu, 1e-13);
          }
    }
  // contradictory numbers
  EXPECT_DOUBLE_EQ(poisson_from(Modulus::bulk, 1., Modulus::young, 9.), -1.);
  EXPECT_DOUBLE_EQ(poisson_from(Modulus::young, 4., Modulus::shear, 1.), 1.);
}


TEST(ElasticityLaws, incompressible)
{
  const Moduli soft = moduli_from(Modulus::bulk, 3., Modulus::poisson, 0.5);
  EXPECT_EQ(soft.bulk, 3.);
  EXPECT_EQ(soft.shear, 0.);
  EXPECT_EQ(soft.young(), 0.);
  EXPECT_EQ(soft.poisson(), 0.5);

  const Moduli rubber = young_and_poisson(3., 0.5);
  EXPECT_TRUE(std::isinf(rubber.bulk));
  EXPECT_DOUBLE_EQ(rubber.shear, 1.);
  EXPECT_DOUBLE_EQ(rubber.young(), 3.);
  EXPECT_DOUBLE_EQ(rubber.poisson(), 0.5);
  EXPECT_DOUBLE_EQ(plane_lambda(rubber, PlaneState::stress), 2.); // E nu/(1 - nu^2)
  const StateLaw law = state_law(rubber, 2, PlaneState::stress);
  EXPECT_DOUBLE_EQ(law.volumetric, 2.); // 2 A, A = 2 G nu/(1 - nu) - G
  EXPECT_DOUBLE_EQ(law.extension, 8.);
  EXPECT_DOUBLE_EQ(state_law(rubber, 1, PlaneState::stress).extension, 3.);
  EXPECT_DOUBLE_EQ(bond_part(rubber, 2, PlaneState::stress), 1.);
  EXPECT_TRUE(std::isfinite(critical_stretch_constant(1., rubber, 1., 2, PlaneState::stress)));
}


TEST(ElasticityLaws, coefficients)
{
  const Moduli m{4., 1.5}; // K, G
  const double nu = m.poisson();
  EXPECT_DOUBLE_EQ(state_law(m, 2, PlaneState::stress).volumetric,
                   2. * (2. * m.shear * nu / (1. - nu) - m.shear));
  EXPECT_DOUBLE_EQ(state_law(m, 2, PlaneState::strain).volumetric, 2. * (4. - 5. / 3. * 1.5));
  EXPECT_DOUBLE_EQ(state_law(m, 2, PlaneState::strain).extension, 8. * 1.5);
  EXPECT_DOUBLE_EQ(state_law(m, 3, PlaneState::stress).volumetric, 3. * 4. - 5. * 1.5);
  EXPECT_DOUBLE_EQ(state_law(m, 3, PlaneState::stress).extension, 15. * 1.5);
  EXPECT_EQ(state_law(m, 1, PlaneState::stress).volumetric, 0.);
  EXPECT_DOUBLE_EQ(state_law(m, 1, PlaneState::stress).extension, m.young());
  EXPECT_DOUBLE_EQ(bond_law(m, 3, PlaneState::stress).extension, 9. * 4.);
  for (unsigned int dim = 1; dim <= 3; ++dim)
    {
      EXPECT_EQ(state_law(m, dim, PlaneState::stress).dilatation, dim);
      EXPECT_EQ(bond_law(m, dim, PlaneState::stress).volumetric, 0.);
    }
  EXPECT_EQ(thermal_strain_factor(m, 2, PlaneState::strain), 1. + nu);
  EXPECT_EQ(thermal_strain_factor(m, 2, PlaneState::stress), 1.);
  EXPECT_EQ(thermal_strain_factor(m, 3, PlaneState::strain), 1.);
}


TEST(ElasticityLaws, state_based_energy_is_classical)
{
  expect_classical_energy<1>(PlaneState::stress);
  expect_classical_energy<2>(PlaneState::stress);
  expect_classical_energy<2>(PlaneState::strain);
  expect_classical_energy<3>(PlaneState::stress);
}


TEST(ElasticityLaws, bond_based_energy)
{
  for (const PlaneState plane : {PlaneState::stress, PlaneState::strain})
    for (unsigned int dim = 1; dim <= 3; ++dim)
      {
        // the state-based law at the Poisson ratio of the model
        const Moduli   own   = young_and_poisson(10., bond_based_poisson(dim, plane));
        const StateLaw state = state_law(own, dim, plane), bond = bond_law(own, dim, plane);
        EXPECT_NEAR(state.volumetric, 0., 1e-14);
        EXPECT_NEAR(bond.extension, state.extension, 1e-13);
      }
  // equal strains in all directions at any other
  for (const double nu : poisson_ratios)
    {
      const Moduli m = young_and_poisson(10., nu);
      for (const PlaneState plane : {PlaneState::stress, PlaneState::strain})
        {
          const auto strain = some_strains<2>()[0];
          EXPECT_NEAR(bond_energy<2>(bond_law(m, 2, plane), strain),
                      bond_energy<2>(state_law(m, 2, plane), strain),
                      1e-15);
        }
      const auto strain = some_strains<3>()[0];
      EXPECT_NEAR(bond_energy<3>(bond_law(m, 3, PlaneState::stress), strain),
                  4.5 * m.bulk * 1e-6,
                  1e-11 * m.bulk);
    }
}


TEST(ElasticityLaws, stresses_of_known_states)
{
  const double          E = 200., nu = 0.3, alpha_dT = 1e-3;
  const Moduli          m = young_and_poisson(E, nu);
  SymmetricTensor<2, 1> bar;
  SymmetricTensor<2, 2> sheet;
  SymmetricTensor<2, 3> solid;
  bar[0][0] = 5e-3;
  EXPECT_NEAR((stress<1>(m, PlaneState::stress, bar, alpha_dT)[0][0]), E * 4e-3, 1e-13);

  // pulled along x and free else, on top of the thermal strain
  const double s = 0.5;
  sheet[0][0]    = s / E + alpha_dT;
  sheet[1][1]    = -nu * s / E + alpha_dT;
  auto in_plane  = stress<2>(m, PlaneState::stress, sheet, alpha_dT);
  EXPECT_NEAR(in_plane[0][0], s, 1e-13);
  EXPECT_NEAR(in_plane[1][1], 0., 1e-13);
  EXPECT_EQ(stress_zz(m, PlaneState::stress, in_plane, alpha_dT), 0.);

  solid[0][0] = s / E + alpha_dT;
  solid[1][1] = solid[2][2] = -nu * s / E + alpha_dT;
  const auto full           = stress<3>(m, PlaneState::stress, solid, alpha_dT);
  EXPECT_NEAR(full[0][0], s, 1e-13);
  EXPECT_NEAR(full[2][2], 0., 1e-13);

  // plane strain is the solid with no strain out of the plane
  sheet[0][1] = 2e-3;
  solid       = 0.;
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int j = i; j < 2; ++j)
      solid[i][j] = sheet[i][j];
  in_plane              = stress<2>(m, PlaneState::strain, sheet, alpha_dT);
  const auto   in_space = stress<3>(m, PlaneState::stress, solid, alpha_dT);
  const double szz      = stress_zz(m, PlaneState::strain, in_plane, alpha_dT);
  EXPECT_NEAR(in_plane[0][0], in_space[0][0], 1e-13);
  EXPECT_NEAR(in_plane[0][1], in_space[0][1], 1e-13);
  EXPECT_NEAR(szz, in_space[2][2], 1e-13);
  EXPECT_NEAR(von_mises(in_plane, szz), von_mises(in_space), 1e-13);
  EXPECT_NEAR(pressure(in_plane, szz), pressure(in_space), 1e-13);
  EXPECT_NEAR(pressure(in_space), -trace(in_space) / 3., 1e-15);

  // bonds in a body that the temperature has strained freely are relaxed
  const double factor = thermal_strain_factor(m, 2, PlaneState::strain);
  sheet               = 0.;
  sheet[0][0] = sheet[1][1] = factor * alpha_dT;
  EXPECT_NEAR(stress<2>(m, PlaneState::strain, sheet, alpha_dT).norm(), 0., 1e-15);
  EXPECT_NEAR(bond_energy<2>(state_law(m, 2, PlaneState::strain), sheet, factor * alpha_dT),
              0.,
              1e-18);
}


TEST(ElasticityLaws, von_mises_of_textbook_states)
{
  SymmetricTensor<2, 3> a;
  a[0][1] = 2.; // pure shear: sqrt(3) tau
  EXPECT_NEAR(von_mises(a), 2. * std::sqrt(3.), 1e-14);
  a[0][0] = a[1][1] = a[2][2] = 1e6; // pressure adds nothing
  EXPECT_NEAR(von_mises(a), 2. * std::sqrt(3.), 1e-9);
  EXPECT_DOUBLE_EQ(pressure(a), -1e6);
  SymmetricTensor<2, 1> bar;
  bar[0][0] = -3.;
  EXPECT_DOUBLE_EQ(von_mises(bar), 3.);
  EXPECT_DOUBLE_EQ(pressure(bar), 1.);
  SymmetricTensor<2, 2> sheet;
  sheet[0][0] = 3.;
  sheet[1][1] = 1.;
  EXPECT_NEAR(von_mises(sheet), std::sqrt(9. - 3. + 1.), 1e-14);
  EXPECT_NEAR(von_mises(sheet, 2.), std::sqrt(0.5 * (4. + 1. + 1.)), 1e-14);
}


namespace
{
  /** alpha tr(sigma) + 9 K alpha^2 dT, of a body that is as free across as it is. */
  template <int dim>
  double entropy_of_stress(const Moduli    &moduli,
                           const PlaneState plane,
                           const double     alpha,
                           const double     trace,
                           const double     dT)
  {
    const SymmetricTensor<2, dim> strain = trace / dim * dealii::unit_symmetric_tensor<dim>();
    const auto                    sigma  = stress<dim>(moduli, plane, strain, alpha * dT);
    double                        szz    = 0.;
    if constexpr (dim == 2)
      szz = stress_zz(moduli, plane, sigma, alpha * dT);
    const double bulk = moduli.young() / (3. * (1. - 2. * moduli.poisson()));
    return -3. * alpha * pressure<dim>(sigma, szz) + 9. * bulk * alpha * alpha * dT;
  }
} // namespace


TEST(ElasticityLaws, entropy_of_deformation)
{
  const double alpha = 1e-3, trace = 0.02, dT = -7.;
  for (const double nu : poisson_ratios)
    {
      const Moduli moduli = young_and_poisson(5., nu);
      for (const PlaneState plane : {PlaneState::stress, PlaneState::strain})
        {
          const double of_stress[] = {entropy_of_stress<1>(moduli, plane, alpha, trace, dT),
                                      entropy_of_stress<2>(moduli, plane, alpha, trace, dT),
                                      entropy_of_stress<3>(moduli, plane, alpha, trace, dT)};
          for (unsigned int dim = 1; dim <= 3; ++dim)
            {
              const double s = entropy_of_deformation(moduli, alpha, dim, plane, trace, dT);
              EXPECT_NEAR(s, of_stress[dim - 1], 1e-12 * std::abs(s) + 1e-15) << dim << ' ' << nu;
            }
        }
    }
  // Free expansion takes up 9 K alpha^2 dT in all of them.
  const Moduli moduli = young_and_poisson(6., 0.25);
  EXPECT_NEAR(entropy_of_deformation(moduli, alpha, 1, PlaneState::stress, alpha * dT, dT),
              36. * alpha * alpha * dT,
              1e-15);
  EXPECT_NEAR(entropy_of_deformation(moduli, alpha, 2, PlaneState::stress, 2. * alpha * dT, dT),
              36. * alpha * alpha * dT,
              1e-15);
  EXPECT_NEAR(entropy_of_deformation(moduli, alpha, 3, PlaneState::stress, 3. * alpha * dT, dT),
              36. * alpha * alpha * dT,
              1e-15);
}


TEST(ElasticityLaws, critical_stretch_of_constant_micromodulus)
{
  const double G0 = 10., delta = 0.02;
  Moduli       m = young_and_poisson(7e4, 0.25);
  EXPECT_NEAR(critical_stretch_constant(G0, m, delta, 3, PlaneState::stress),
              std::sqrt(5. * G0 / (9. * m.bulk * delta)),
              1e-12);
  EXPECT_NEAR(critical_stretch_constant(G0, m, delta, 2, PlaneState::strain),
              std::sqrt(5. * pi * G0 / (12. * m.young() * delta)),
              1e-12);
  m = young_and_poisson(7e4, 1. / 3.);
  EXPECT_NEAR(critical_stretch_constant(G0, m, delta, 2, PlaneState::stress),
              std::sqrt(4. * pi * G0 / (9. * m.young() * delta)),
              1e-12);
  EXPECT_NEAR(critical_stretch_constant(G0, m, delta, 1, PlaneState::stress),
              std::sqrt(3. * G0 / (m.young() * delta)),
              1e-12);

  // The energy of all bonds across a unit area, point by point of a line normal to it (2D): both
  // halves of each bond.
  m                 = young_and_poisson(7e4, 0.1);
  const double    s = critical_stretch_constant(G0, m, delta, 2, PlaneState::strain);
  const double    q = 2. / 3. * pi * std::pow(delta, 3); // of omega = 1/r
  const double    c = bond_law(m, 2, PlaneState::strain).extension / q;
  const GaussRule rule(40);
  const double    energy = rule.integrate(0., delta, [&](const double z) {
    return rule.integrate(z, delta, [&](const double r) {
      return 2. * std::acos(z / r) * r * c * s * s *
             r; // t e = c omega (s r)^2 on an arc of length 2 acos(z/r) r
    });
  });
  EXPECT_NEAR(energy, G0, 2e-4 * G0);
}


TEST(ElasticityLaws, bond_part_leaves_a_semidefinite_remainder)
{
  for (const double nu : {-0.8, -0.3, 0., 0.25, 1. / 3., 0.45, 0.49})
    {
      const Moduli m = young_and_poisson(10., nu);
      for (unsigned int dim = 1; dim <= 3; ++dim)
        for (const PlaneState plane : {PlaneState::stress, PlaneState::strain})
          {
            const double k = bond_part(m, dim, plane);
            EXPECT_GT(k, 0.);
            if (dim == 1)
              {
                EXPECT_DOUBLE_EQ(3. * k, m.young());
                continue;
              }
            const double lambda = lambda_of(m, dim, plane) - k, shear = m.shear - k;
            EXPECT_GE(shear, -1e-13);
            EXPECT_GE(dim * lambda + 2. * shear, -1e-13);
            EXPECT_NEAR(std::min(shear, dim * lambda + 2. * shear),
                        0.,
                        1e-13); // the largest such k
          }
      EXPECT_NEAR(bond_part(m, 2, PlaneState::strain),
                  std::min(m.shear, (m.lambda() + m.shear) / 2.),
                  1e-13);
      EXPECT_NEAR(bond_part(m, 3, PlaneState::strain),
                  std::min(m.shear, (3. * m.lambda() + 2. * m.shear) / 5.),
                  1e-13);
    }
  const double own = bond_based_poisson(2, PlaneState::stress);
  const Moduli m   = young_and_poisson(10., own);
  EXPECT_NEAR(bond_part(m, 2, PlaneState::stress), m.shear, 1e-13); // bonds carry it all
}
