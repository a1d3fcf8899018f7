// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Integrals about places of crack fronts in three dimensions, with fields that are known.

#include <perideal/analysis/front_intensity.h>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

using namespace PeriDeal;

namespace
{
  using dealii::Point;
  using dealii::Tensor;
  using Field = std::function<Tensor<1, 3>(const Point<3> &)>;

  const double pi = std::acos(-1.), young = 3., poisson = 0.3, radius = 1.;
  const Moduli moduli = moduli_from(Modulus::young, young, Modulus::poisson, poisson);


  /** Near-tip fields (Irwin) of a straight front along z, the crack in x < 0. */
  Tensor<1, 3> straight(const Point<3> &p, const Tensor<1, 3> &K)
  {
    const double r = std::hypot(p[0], p[1]), angle = std::atan2(p[1], p[0]);
    const double s = std::sin(0.5 * angle), c = std::cos(0.5 * angle), kappa = 3. - 4. * poisson;
    const double factor = std::sqrt(r / (2. * pi)) / (2. * moduli.shear);
    return factor * Tensor<1, 3>(
                      {K[0] * c * (kappa - 1. + 2. * s * s) + K[1] * s * (kappa + 1. + 2. * c * c),
                       K[0] * s * (kappa + 1. - 2. * c * c) - K[1] * c * (kappa - 1. - 2. * s * s),
                       4. * K[2] * s});
  }


  /**
   * A disc of radius 1 in the plane z = 0 in an infinite body under tension (Sneddon 1946, as
   * Fabrikant 1989 writes it) and shear along x; its faces are free.
   */
  Tensor<1, 3> disc(const Point<3> &p, const double tension, const double shear)
  {
    const double r = std::hypot(p[0], p[1]), z = p[2], nu = poisson;
    const double far = std::hypot(r + radius, z), near = std::hypot(r - radius, z);
    const double l_1 = 0.5 * (far - near), l_2 = 0.5 * (far + near), w = far * near;
    const double root = std::sqrt(l_2 * l_2 - radius * radius),
                 edge = std::sqrt(std::max(0., radius * radius - l_1 * l_1)),
                 turn = std::asin(radius / l_2);
    const double gap = std::copysign(edge, z) - z * turn, F = turn - root / (l_2 * l_2);
    const double in_plane = tension / (2. * pi * moduli.shear) *
                            (2. * std::abs(z) * edge / (l_2 * l_2 * w) - (1. - 2. * nu) * F);
    Tensor<1, 3> u(
      {in_plane * p[0],
       in_plane * p[1],
       tension / (pi * moduli.shear) * (2. * (1. - nu) * gap + z * (turn - root / w))});
    const double       B    = 4. * (1. - nu) * shear / (pi * moduli.shear * (2. - nu));
    const double       fall = -2. * root / (l_2 * l_2 * l_2 * l_2 * w);
    const Tensor<1, 3> slope({0.5 * B * (F + p[0] * p[0] * fall),
                              0.5 * B * p[0] * p[1] * fall,
                              -B * p[0] * z / (root * l_2 * l_2 * w)});
    u[0] += B * gap;
    u[2] += (1. - 2. * nu) / (2. * (1. - nu)) * 0.5 * B * p[0] * F;
    u -= z / (2. * (1. - nu)) * slope;
    // without the crack
    u += tension / young * Tensor<1, 3>({-nu * p[0], -nu * p[1], z});
    u[0] += shear / moduli.shear * z;
    return u;
  }


  RingPoint<3> known_at(const Field &field, const Point<3> &p, const double volume)
  {
    constexpr double h = 1e-5;
    RingPoint<3>     point;
    point.place  = p;
    point.weight = volume;
    for (unsigned int d = 0; d < 3; ++d)
      {
        Tensor<1, 3> step;
        step[d]                   = h;
        const Tensor<1, 3> change = field(p + step) - field(p - step);
        for (unsigned int i = 0; i < 3; ++i)
          point.gradient[i][d] = change[i] / (2. * h);
      }
    return point;
  }


  /** What strains a free body, and what a weight along x does to a column (along x). */
  const Tensor<1, 3> slope_of_heat({0.6, -0.4, 0.3});
  constexpr double   weight = 0.8;

  Tensor<1, 3> warm_and_heavy(const Point<3> &p)
  {
    const Tensor<1, 3> x(p);
    return (slope_of_heat * x) * x - 0.5 * x.norm_square() * slope_of_heat +
           weight / young *
             Tensor<1, 3>({-0.5 * (p[0] * p[0] + poisson * (p[1] * p[1] + p[2] * p[2])),
                           poisson * p[0] * p[1],
                           poisson * p[0] * p[2]});
  }


  /** Of a field on cylinders about the front, the points of which are no corners of cells. */
  StressIntensity found(const FrontPlace &at, const Field &field, const bool loaded = false)
  {
    FrontIntegral          integral(at, 0., moduli);
    constexpr unsigned int n_rings = 32, n_rays = 48, n_along = 16;
    const Tensor<1, 3>     along = cross_product_3d(at.ahead, at.normal);
    for (unsigned int k = 0; k < n_rings; ++k)
      for (unsigned int l = 0; l < n_rays; ++l)
        for (unsigned int m = 0; m < n_along; ++m)
          {
            const double r     = at.outer * (k + 0.5) / n_rings;
            const double angle = -pi + 2. * pi * (l + 0.5) / n_rays;
            const double s     = at.half * ((2. * m + 1.) / n_along - 1.);
            const double x_1 = r * std::cos(angle), turn = at.curvature * s,
                         bent        = 1. + at.curvature * x_1;
            const Tensor<1, 3> ahead = std::cos(turn) * at.ahead + std::sin(turn) * along;
            const Point<3>     p     = at.place + r * std::sin(angle) * at.normal +
                               (at.curvature == 0. ? x_1 * at.ahead + s * along :
                                                     (bent * ahead - at.ahead) / at.curvature);
            const double volume =
              at.outer / n_rings * r * 2. * pi / n_rays * 2. * at.half / n_along * bent;
            RingPoint<3> point = known_at(field, p, volume);
            if (loaded)
              {
                point.gradient += known_at(warm_and_heavy, p, volume).gradient;
                point.thermal_strain = slope_of_heat * Tensor<1, 3>(p);
                point.thermal_slope  = slope_of_heat;
                point.force[0]       = weight;
              }
            integral.add(point);
          }
    return integral.result(MPI_COMM_SELF);
  }


  void expect(const StressIntensity &values, const Tensor<1, 3> &K, const double error)
  {
    EXPECT_NEAR(values.mode_1, K[0], error);
    EXPECT_NEAR(values.mode_2, K[1], error);
    EXPECT_NEAR(*values.mode_3, K[2], error);
    EXPECT_NEAR(values.j,
                (1. - poisson * poisson) / young * (K[0] * K[0] + K[1] * K[1]) +
                  K[2] * K[2] / (2. * moduli.shear),
                error);
  }


  FrontPlace about(const Point<3> &place, const Tensor<1, 3> &ahead, const Tensor<1, 3> &normal)
  {
    FrontPlace at;
    at.place  = place;
    at.ahead  = ahead;
    at.normal = normal;
    at.inner  = 0.2;
    at.outer = at.half = at.share = 0.4; // H of half length 1 has the integral 1
    return at;
  }
} // namespace


TEST(FrontIntensity, three_modes_of_a_straight_front)
{
  const FrontPlace at =
    about(Point<3>(0.1, 0.2, 0.3), Tensor<1, 3>({1., 0., 0.}), Tensor<1, 3>({0., 1., 0.}));
  const Tensor<1, 3> K({1.3, -0.7, 0.9});
  const Field        field = [&](const Point<3> &p) { return straight(Point<3>(p - at.place), K); };
  expect(found(at, field), K, 2e-3);
  expect(found(at, field, true), K, 5e-3); // heat and weight load no crack
  // The same crack with its other side as the left one.
  FrontPlace turned = at;
  turned.normal     = -at.normal;
  expect(found(turned, field), Tensor<1, 3>({K[0], -K[1], K[2]}), 2e-3);
}


TEST(FrontIntensity, disc_under_tension_and_shear)
{
  const double root = std::sqrt(radius / pi), sheared = 4. * root / (2. - poisson);
  for (const double part : {0., 0.125, 0.25})
    {
      const double   angle = 2. * pi * part;
      const Point<3> place(std::cos(angle), std::sin(angle), 0.);
      FrontPlace     at  = about(place, Tensor<1, 3>(place), Tensor<1, 3>({0., 0., 1.}));
      at.curvature       = 1.;
      const Field pulled = [](const Point<3> &p) { return disc(p, 1., 0.); };
      for (const bool loaded : {false, true})
        expect(found(at, pulled, loaded), Tensor<1, 3>({2. * root, 0., 0.}), 0.01);
      const StressIntensity values = found(at, [](const Point<3> &p) { return disc(p, 0., 1.); });
      // e_3 = x at part = 0.25: there the shear is along the front.
      const Tensor<1, 3> K(
        {0., sheared * std::cos(angle), (1. - poisson) * sheared * std::sin(angle)});
      EXPECT_NEAR(values.mode_1, 0., 0.01);
      EXPECT_NEAR(values.mode_2, K[1], 0.02) << part;
      EXPECT_NEAR(*values.mode_3, K[2], 0.02) << part;
      // A mean along the front, where J is between 0.37 and 0.53.
      EXPECT_NEAR(values.j,
                  (1. - poisson * poisson) / young * K[1] * K[1] +
                    K[2] * K[2] / (2. * moduli.shear),
                  0.01)
        << part;
    }
}
