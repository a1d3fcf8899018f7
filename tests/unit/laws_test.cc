// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Laws on paper: calibration constants, volume fractions, lattice families, interfaces and cracks.

#include <perideal/base/user_error.h>
#include <perideal/laws/crack_conductance.h>
#include <perideal/laws/gauss_rule.h>
#include <perideal/laws/interface.h>
#include <perideal/laws/kernel.h>
#include <perideal/laws/lattice_family.h>
#include <perideal/laws/volume_fraction.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "scene_test_tools.h"

using namespace PeriDeal;

namespace
{
  const double pi = std::acos(-1.);

  const std::array<KernelShape, 3> shapes{
    {KernelShape::constant, KernelShape::conical, KernelShape::gaussian}};


  template <int dim>
  dealii::Tensor<1, dim> cubic(const double h)
  {
    dealii::Tensor<1, dim> spacing;
    for (unsigned int d = 0; d < dim; ++d)
      spacing[d] = h;
    return spacing;
  }


  /** sum w V xi_x^2 / (2 kappa) at horizon m h without calibration. */
  template <int dim>
  double analytic_conductivity(const double         m,
                               const KernelShape    shape,
                               const unsigned int   n,
                               const VolumeFraction fraction)
  {
    const auto h = cubic<dim>(0.1);
    return effective_conductivity<dim>(
      lattice_family<dim>(h, 0.1 * m, shape, n, fraction, Calibration::analytic),
      h)[0];
  }


  /**
   * Volume of a ball of radius delta put together from the fractions of the cells of a lattice with
   * unequal edges.
   */
  template <int dim>
  double ball_from_cells(const double delta)
  {
    const std::array<double, 3> h{{1., 1.2, 0.9}};
    std::array<double, dim>     edges;
    std::array<int, dim>        offset, reach;
    double                      cell = 1., volume = 0.;
    for (unsigned int d = 0; d < dim; ++d)
      {
        edges[d]  = h[d];
        reach[d]  = static_cast<int>(delta / h[d] + 1.);
        offset[d] = -reach[d];
        cell *= h[d];
      }
    for (unsigned int d = 0; d < dim;)
      {
        std::array<double, dim> center;
        for (unsigned int a = 0; a < dim; ++a)
          center[a] = offset[a] * h[a];
        volume += cell * exact_fraction<dim>(center, edges, delta);
        for (d = 0; d < dim && ++offset[d] > reach[d]; ++d)
          offset[d] = -reach[d];
      }
    return volume;
  }


  template <int dim>
  void expect_symmetric(const dealii::Tensor<1, dim> &h, const VolumeFraction fraction)
  {
    const auto family =
      lattice_family<dim>(h, 3.2 * h[0], KernelShape::conical, 2, fraction, Calibration::discrete);
    std::map<std::array<int, dim>, double> weight_of; // by offset with absolute values
    for (const auto &member : family)
      {
        EXPECT_GT(member.weight, 0.);
        std::array<int, dim> mirrored = member.offset;
        for (int &o : mirrored)
          o = std::abs(o);
        const auto found = weight_of.emplace(mirrored, member.weight).first;
        EXPECT_EQ(found->second, member.weight);
      }
    for (std::size_t i = 1; i < family.size(); ++i)
      EXPECT_TRUE(std::lexicographical_compare(family[i - 1].offset.rbegin(),
                                               family[i - 1].offset.rend(),
                                               family[i].offset.rbegin(),
                                               family[i].offset.rend()));
    for (const double e : effective_conductivity<dim>(family, h))
      EXPECT_NEAR(e, 1., 1e-13);
  }
} // namespace


TEST(Laws, GaussRuleIsExactForPolynomials)
{
  for (const unsigned int n : {1u, 2u, 5u, 12u, 24u})
    {
      const GaussRule rule(n);
      for (unsigned int p = 0; p < 2 * n; ++p)
        EXPECT_NEAR(rule.integrate(0., 1., [p](const double x) { return std::pow(x, p); }),
                    1. / (p + 1.),
                    1e-14);
    }
}


// The printed constants: Bobaru 2010 eqs 16 and 17, Bobaru 2012 (plane), and the table for other
// exponents.
TEST(Laws, MicroConductivityTable)
{
  const double delta = 0.7, kappa = 1.14;
  for (unsigned int n = 0; n <= 2; ++n)
    {
      const double                bond = n;
      const std::array<double, 3> constant{
        {(3. - bond) * kappa / std::pow(delta, 3. - bond),
         2. * (4. - bond) * kappa / (pi * std::pow(delta, 4. - bond)),
         3. * (5. - bond) * kappa / (2. * pi * std::pow(delta, 5. - bond))}};
      for (unsigned int dim = 1; dim <= 3; ++dim)
        {
          const double k0 = constant[dim - 1], k1 = k0 * (dim + 3. - bond);
          EXPECT_NEAR(micro_conductivity(dim, KernelShape::constant, n, delta, kappa) / k0,
                      1.,
                      1e-14);
          EXPECT_NEAR(micro_conductivity(dim, KernelShape::conical, n, delta, kappa) / k1,
                      1.,
                      1e-14);
        }
    }
  EXPECT_NEAR(micro_conductivity(1, KernelShape::constant, 2, delta, kappa), kappa / delta, 1e-14);
  EXPECT_NEAR(micro_conductivity(1, KernelShape::conical, 2, delta, kappa),
              2. * kappa / delta,
              1e-14);
  EXPECT_NEAR(micro_conductivity(2, KernelShape::conical, 2, delta, kappa),
              12. * kappa / (pi * delta * delta),
              1e-13);
}


// integral over the ball of k(r)/r^n xi_x^2 dV = 2 kappa, by quadrature over radius and directions.
TEST(Laws, MomentIdentity)
{
  const double    delta = 0.7, kappa = 1.3;
  const GaussRule rule(40);
  const double    sphere_mean = rule.integrate(-1., 1., [](const double z) { return 0.5 * z * z; });
  double          circle_mean = 0.;
  for (unsigned int i = 0; i < 16; ++i)
    circle_mean += std::pow(std::cos(2. * pi * i / 16.), 2) / 16.;
  const std::array<double, 3> directions{{2., 2. * pi * circle_mean, 4. * pi * sphere_mean}};
  for (unsigned int dim = 1; dim <= 3; ++dim)
    for (const KernelShape shape : shapes)
      for (unsigned int n = 0; n <= 2; ++n)
        {
          const double k0     = micro_conductivity(dim, shape, n, delta, kappa);
          const double moment = rule.integrate(0., delta, [&](const double r) {
            return k0 * kernel_shape(shape, r, delta) * std::pow(r, static_cast<int>(dim + 1 - n));
          });
          EXPECT_NEAR(directions[dim - 1] * moment, 2. * kappa, 1e-13) << dim << " " << n;
        }
}


TEST(Laws, LinearFractionAndShiftedDistance)
{
  const double h = 0.1, delta = 0.3;
  EXPECT_EQ(linear_fraction(0.25, delta, h), 1.);
  EXPECT_NEAR(linear_fraction(3. * h, delta, h), 0.5, 1e-14);
  EXPECT_NEAR(linear_fraction(0.33, delta, h), 0.2, 1e-14);
  EXPECT_EQ(linear_fraction(0.35, delta, h), 0.); // up to rounding
  EXPECT_EQ(linear_fraction(0.35 * (1. + 1e-15), delta, h), 0.);
  EXPECT_EQ(linear_fraction(0.4, delta, h), 0.);
  EXPECT_EQ(shifted_distance(0.2, delta, h), 0.2);
  EXPECT_NEAR(shifted_distance(0.28, delta, h), 0.28 - 0.3 * 0.05, 1e-15);
  EXPECT_NEAR(shifted_distance(0.3, delta, h), 0.275, 1e-15);
  EXPECT_NEAR(shifted_distance(0.33, delta, h), 0.3 - 0.2 * 0.05, 1e-15);
  EXPECT_EQ(plain_fraction(0.1 + 0.1 + 0.1, 0.3), 1.); // 0.30000000000000004
  EXPECT_EQ(plain_fraction(0.3001, 0.3), 0.);
}


TEST(Laws, ExactFractionClosedForms)
{
  EXPECT_NEAR((exact_fraction<1>({{1.}}, {{0.5}}, 0.9)), 0.3, 1e-14);
  // A quarter of the unit disc in a unit square, a half disc, a whole one; the cell that holds an
  // octant of a ball.
  EXPECT_NEAR((exact_fraction<2>({{0.5, 0.5}}, {{1., 1.}}, 1.)), pi / 4., 1e-14);
  EXPECT_NEAR((exact_fraction<2>({{-1., 0.}}, {{2., 4.}}, 1.)), pi / 16., 1e-14);
  EXPECT_NEAR((exact_fraction<2>({{0., 0.}}, {{4., 4.}}, 1.)), pi / 16., 1e-14);
  EXPECT_NEAR((exact_fraction<3>({{0.5, -0.5, 0.5}}, {{1., 1., 1.}}, 1.)), pi / 6., 1e-12);
  EXPECT_NEAR((exact_fraction<3>({{0., 0., 0.}}, {{4., 4., 4.}}, 1.)), pi / 48., 1e-12);
  // A cap of height 0.25 that touches no edge of the box.
  EXPECT_NEAR((exact_fraction<3>({{1.25, 0., 0.}}, {{1., 4., 4.}}, 1.)),
              pi * 0.0625 * (3. - 0.25) / 3. / 16.,
              1e-12);
  EXPECT_EQ((exact_fraction<3>({{0.8, 0.8, 0.8}}, {{0.1, 0.1, 0.1}}, 1.299)), 0.);
  EXPECT_EQ((exact_fraction<3>({{0.8, 0.8, 0.8}}, {{0.1, 0.1, 0.1}}, 1.6)), 1.);
  // Where the ball just reaches a corner: a tetrahedron.
  const double depth = 1.3 - 0.75 * std::sqrt(3.);
  EXPECT_NEAR((exact_fraction<3>({{0.8, 0.8, 0.8}}, {{0.1, 0.1, 0.1}}, 1.3)),
              std::pow(std::sqrt(3.) * depth, 3) / 6e-3,
              5e-9);
}


TEST(Laws, ExactFractionsAddUpToTheBall)
{
  for (const double delta : {1., 2.5, 3., 3.015, 6.5})
    {
      EXPECT_NEAR(ball_from_cells<1>(delta) / (2. * delta), 1., 1e-13);
      EXPECT_NEAR(ball_from_cells<2>(delta) / (pi * delta * delta), 1., 1e-13);
      EXPECT_NEAR(ball_from_cells<3>(delta) / (4. / 3. * pi * delta * delta * delta), 1., 1e-12);
    }
}


// How far off a lattice conducts without discrete calibration.
TEST(Laws, EffectiveConductivityWithoutCalibration)
{
  using VF = VolumeFraction;
  EXPECT_NEAR(analytic_conductivity<2>(3., KernelShape::conical, 2, VF::none), 0.889177, 1e-6);
  EXPECT_NEAR(analytic_conductivity<2>(3., KernelShape::conical, 2, VF::linear), 0.930627, 1e-6);
  EXPECT_NEAR(analytic_conductivity<2>(3., KernelShape::conical, 2, VF::exact), 0.881730, 1e-6);
  EXPECT_NEAR(analytic_conductivity<2>(6.5, KernelShape::conical, 2, VF::linear), 0.98431, 1e-5);
  EXPECT_NEAR(analytic_conductivity<1>(3.015, KernelShape::constant, 1, VF::none), 1.320099, 1e-6);
  EXPECT_NEAR(analytic_conductivity<3>(1.733, KernelShape::constant, 1, VF::none), 1.299636, 1e-6);
}


TEST(Laws, LatticeFamilyIsSymmetricSortedAndCalibrated)
{
  for (const VolumeFraction fraction :
       {VolumeFraction::none, VolumeFraction::linear, VolumeFraction::exact})
    {
      expect_symmetric<1>(cubic<1>(0.1), fraction);
      expect_symmetric<2>(cubic<2>(1. / 3.), fraction);
      expect_symmetric<3>(cubic<3>(1. / 7.), fraction);
      expect_symmetric<2>(dealii::Tensor<1, 2>({0.1, 0.13}), fraction);
      expect_symmetric<3>(dealii::Tensor<1, 3>({0.1, 0.08, 0.11}), fraction);
    }
  // On a square lattice permuted offsets, too, have the same bits.
  double one = 0., two = 0.;
  for (const auto &member : lattice_family<2>(cubic<2>(1. / 3.),
                                              1.,
                                              KernelShape::conical,
                                              2,
                                              VolumeFraction::linear,
                                              Calibration::discrete))
    {
      if (member.offset == std::array<int, 2>{{1, -2}})
        one = member.weight;
      if (member.offset == std::array<int, 2>{{2, 1}})
        two = member.weight;
    }
  EXPECT_GT(one, 0.);
  EXPECT_EQ(one, two);
}


namespace
{
  /** The largest error of all fourth moments, and of the second ones. */
  template <int dim>
  double anisotropy(const dealii::Tensor<1, dim> &h, const double m, const unsigned int n)
  {
    dealii::Tensor<4, dim> sum;
    double                 volume = 1.;
    for (unsigned int d = 0; d < dim; ++d)
      volume *= h[d];
    for (const auto &member : lattice_family<dim>(h,
                                                  m * *std::min_element(h.begin_raw(), h.end_raw()),
                                                  KernelShape::conical,
                                                  n,
                                                  VolumeFraction::linear,
                                                  Calibration::isotropic))
      {
        EXPECT_GT(member.weight, 0.);
        dealii::Tensor<1, dim> xi;
        for (unsigned int d = 0; d < dim; ++d)
          xi[d] = member.offset[d] * h[d];
        const auto pair = outer_product(xi, xi);
        sum += member.weight * volume / xi.norm_square() * outer_product(pair, pair);
      }
    double worst = 0.;
    for (unsigned int a = 0; a < dim; ++a)
      for (unsigned int b = 0; b < dim; ++b)
        for (unsigned int c = 0; c < dim; ++c)
          for (unsigned int d = 0; d < dim; ++d)
            {
              const double wanted =
                2. / (dim + 2.) * ((a == b && c == d) + (a == c && b == d) + (a == d && b == c));
              worst = std::max(worst, std::abs(sum[a][b][c][d] - wanted));
            }
    return worst;
  }
} // namespace


TEST(Laws, IsotropicFamilies)
{
  EXPECT_LT(anisotropy<1>(cubic<1>(0.1), 3., 0), 1e-14);
  for (const unsigned int n : {0u, 1u, 2u})
    for (const double m : {1.5, 2., 3., 3.015, 6.})
      {
        EXPECT_LT(anisotropy<2>(cubic<2>(0.1), m, n), 1e-13) << m << ' ' << n;
        EXPECT_LT(anisotropy<3>(cubic<3>(0.1), m, n), 1e-13) << m << ' ' << n;
      }
  EXPECT_LT(anisotropy<2>(dealii::Tensor<1, 2>({0.1, 0.13}), 3., 0), 1e-13);
  EXPECT_LT(anisotropy<3>(dealii::Tensor<1, 3>({0.1, 0.08, 0.11}), 3., 1), 1e-13);
  // Bonds along the axes alone: nothing holds shear.
  const std::string message = SceneTests::message_of([] { anisotropy<2>(cubic<2>(0.1), 0.9, 0); });
  EXPECT_NE(message.find("'Horizon ratio' in section 'Peridynamics'"), std::string::npos)
    << message;
}


// Where `Calibration = auto` takes them: two spacings along the longest edge, edges 1 : 1.5.
TEST(Laws, IsotropicFamiliesOfTheDefault)
{
  const auto has = [](const auto &h, const double m) {
    constexpr int dim     = std::decay_t<decltype(h)>::dimension;
    const double  horizon = m * *std::max_element(h.begin_raw(), h.end_raw());
    for (const KernelShape shape :
         {KernelShape::constant, KernelShape::conical, KernelShape::gaussian})
      for (const unsigned int n : {0u, 1u, 2u})
        for (const VolumeFraction fraction :
             {VolumeFraction::none, VolumeFraction::linear, VolumeFraction::exact})
          {
            const std::string message = SceneTests::message_of(
              [&] { lattice_family<dim>(h, horizon, shape, n, fraction, Calibration::isotropic); });
            EXPECT_EQ(message, "") << h << ": " << m << ' ' << static_cast<int>(shape) << ' ' << n
                                   << ' ' << static_cast<int>(fraction);
          }
  };
  for (const double m : {2., 2.2, 2.5, 3., 3.3, 4.})
    {
      for (const double b : {1., 1.1, 1.25, 1.5})
        has(dealii::Tensor<1, 2>({1., b}), m);
      has(dealii::Tensor<1, 3>({1., 1., 1.}), m);
      for (const double b : {1., 1.2, 1.5})
        has(dealii::Tensor<1, 3>({1., b, 1.5}), m);
    }
}


TEST(Laws, FamilySizes)
{
  const auto size = [](const double m, const KernelShape shape, const VolumeFraction fraction) {
    return lattice_family<2>(cubic<2>(0.1), 0.1 * m, shape, 2, fraction, Calibration::analytic)
      .size();
  };
  EXPECT_EQ(size(3., KernelShape::constant, VolumeFraction::none), 28u);  // r = delta included
  EXPECT_EQ(size(3., KernelShape::conical, VolumeFraction::none), 24u);   // of no weight there
  EXPECT_EQ(size(3., KernelShape::conical, VolumeFraction::linear), 36u); // up to r < 3.5 h
  EXPECT_EQ(size(3.015, KernelShape::constant, VolumeFraction::none), 28u);
}


TEST(Laws, TooSmallHorizonIsAUserError)
{
  const auto message =
    [](const dealii::Tensor<1, 2> &h, const double delta, const Calibration calibration) {
      return SceneTests::message_of([&] {
        lattice_family<2>(h, delta, KernelShape::conical, 2, VolumeFraction::none, calibration);
      });
    };
  for (const Calibration calibration : {Calibration::discrete, Calibration::analytic})
    {
      for (const std::string &text :
           {message(cubic<2>(0.1), 0.09, calibration),
            message(cubic<2>(0.1), 0.1, calibration), // conical: zero at delta
            message(dealii::Tensor<1, 2>({0.1, 1.}), 0.5, calibration)})
        SceneTests::expect_parts(text, {"'Horizon ratio'", "'Peridynamics'"});
      EXPECT_EQ(message(cubic<2>(0.1), 0.11, calibration), "");
    }
}


// Conductivities that the self term of Bobaru 2012 leads to: 1.066 at m = 6.5 and 1.341 at 2.6 with
// Algorithm 1.
TEST(Laws, PaperSelfTerm)
{
  const auto self_term = [](const auto       &spacing,
                            const double      delta,
                            const KernelShape shape,
                            const Calibration calibration) {
    return self_term_family<std::decay_t<decltype(spacing)>::dimension>(spacing,
                                                                        delta,
                                                                        shape,
                                                                        2,
                                                                        VolumeFraction::linear,
                                                                        calibration);
  };
  const auto total = [&](const double m) {
    const auto h    = cubic<2>(0.1);
    const auto self = self_term(h, 0.1 * m, KernelShape::conical, Calibration::analytic);
    EXPECT_EQ(self.size(), 8u);
    return analytic_conductivity<2>(m, KernelShape::conical, 2, VolumeFraction::linear) +
           effective_conductivity<2>(self, h)[0];
  };
  EXPECT_NEAR(total(6.5), 1.06632, 1e-5);
  EXPECT_NEAR(total(2.6), 1.34101, 1e-5);

  const double h = 0.1, delta = 0.4;
  for (const KernelShape shape : {KernelShape::constant, KernelShape::conical})
    {
      const auto self = self_term(cubic<1>(h), delta, shape, Calibration::analytic);
      ASSERT_EQ(self.size(), 2u);
      // Bobaru 2010: k0 = 1/delta, k1 = 2/delta.
      const double k = (shape == KernelShape::constant ? 1. : 2.) / delta;
      EXPECT_NEAR(self[0].weight, 0.5 * k / (h * h), 1e-12);
      EXPECT_EQ(self[0].weight, self[1].weight);
    }

  // The calibration factor of the family goes with it.
  const auto weight = [&](const Calibration calibration) {
    return self_term(cubic<2>(h), 0.3, KernelShape::conical, calibration)[0].weight;
  };
  EXPECT_NEAR(weight(Calibration::analytic) / weight(Calibration::discrete), 0.930627, 1e-6);
  EXPECT_THROW(self_term(cubic<3>(h), 0.3, KernelShape::conical, Calibration::discrete), UserError);
}


TEST(Laws, InterfaceRules)
{
  EXPECT_EQ(interface_conductivity(InterfaceRule::minimum, 2., 6.), 2.);
  EXPECT_EQ(interface_conductivity(InterfaceRule::arithmetic, 2., 6.), 4.);
  EXPECT_NEAR(interface_conductivity(InterfaceRule::harmonic, 2., 6.), 3., 1e-15);
  EXPECT_EQ(interface_conductivity(InterfaceRule::harmonic, 0., 0.), 0.);
  for (const InterfaceRule rule :
       {InterfaceRule::minimum, InterfaceRule::arithmetic, InterfaceRule::harmonic})
    EXPECT_EQ(interface_conductivity(rule, 0.1, 0.7), interface_conductivity(rule, 0.7, 0.1));
}


TEST(Laws, HarmonicConductivityAlongABond)
{
  const auto relative_error = [](const std::function<double(const double)> &kappa,
                                 const double                               resistance) {
    return std::abs(harmonic_conductivity(kappa) * resistance - 1.);
  };
  EXPECT_LT(relative_error([](double) { return 3.; }, 1. / 3.), 1e-14);
  // Two and three phases, 1 : 1000.
  EXPECT_LT(relative_error([](double s) { return s < 0.3123 ? 1. : 1000.; }, 0.3123 + 0.6877e-3),
            1e-11);
  EXPECT_LT(relative_error([](double s) { return s > 0.3123 && s < 0.71 ? 1000. : 1.; },
                           1. - 0.3977 + 0.3977e-3),
            1e-11);
  // Crossings at and next to the ends and where pieces meet.
  for (const double at : {0., 1e-6, 0.001, 0.2499, 0.25, 0.5, 0.999, 1.})
    EXPECT_LT(relative_error([at](double s) { return s < at ? 2. : 5.; }, at / 2. + (1. - at) / 5.),
              1e-11)
      << at;
  // Graded, and graded with a jump, large and small.
  EXPECT_LT(relative_error([](double s) { return std::exp(2. * s); }, (1. - std::exp(-2.)) / 2.),
            1e-12);
  EXPECT_LT(relative_error([](double s) { return s < 0.6 ? std::exp(2. * s) : 5.; },
                           (1. - std::exp(-1.2)) / 2. + 0.08),
            1e-11);
  EXPECT_LT(relative_error([](double s) { return std::exp(s) * (s < 0.249 ? 1. : 1.001); },
                           1. - std::exp(-.249) + (std::exp(-.249) - std::exp(-1.)) / 1.001),
            1e-10);
  // A phase that does not conduct.
  EXPECT_EQ(harmonic_conductivity([](double s) { return s < 0.4 ? 0. : 1.; }), 0.);
}


TEST(Laws, CrackConductance)
{
  const double infinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(contact_fraction(0., 0.1, 2.), 0.);
  EXPECT_EQ(contact_fraction(infinite, 0.1, 2.), 1.);
  EXPECT_EQ(contact_fraction(5., 0., 2.), 0.);
  EXPECT_NEAR(contact_fraction(5., -0.4, 2.), 0.5, 1e-15);
  // As a series of two resistances: kappa/|xi.n| t = 1/(|xi.n|/kappa + 1/H).
  EXPECT_NEAR(2. / 0.1 * contact_fraction(3., 0.1, 2.), 1. / (0.1 / 2. + 1. / 3.), 1e-14);

  EXPECT_NEAR(contact_conductance_of_transmission(0.5, 2., 0.1, 2.), 1.9 * 20., 1e-12);
  EXPECT_NEAR(contact_conductance_of_transmission(0.5, 2., 0.1, 3.), 2.4 * 20., 1e-12);
  EXPECT_NEAR(contact_conductance_of_transmission(0.5, 2., 0.1, 2.5), 2.15 * 20., 1e-12);
  EXPECT_NEAR(contact_conductance_of_transmission(0.5, 2., 0.1, 6.5), 2.4 * 20., 1e-12);
  EXPECT_EQ(contact_conductance_of_transmission(1., 2., 0.1, 3.), infinite);
  EXPECT_EQ(contact_conductance_of_transmission(0., 2., 0.1, 3.), 0.);
  for (const double t : {0., 0.1, 0.5, 0.9, 1.})
    EXPECT_NEAR(
      transmission_of_contact_conductance(contact_conductance_of_transmission(t, 1.14, 0.05, 2.7),
                                          1.14,
                                          0.05,
                                          2.7),
      t,
      1e-14);
}
