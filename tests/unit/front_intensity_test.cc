// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Integrals about places of crack fronts in three dimensions, with fields that are known.

#include <perideal/analysis/bond_intensities.h>
#include <perideal/analysis/front_intensity.h>
#include <perideal/analysis/tip_field.h>

#include <cmath>
#include <functional>
#include <sstream>

#include "elastic_test_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;

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
    FrontIntegral          integral(at, 0., 0., moduli);
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


namespace
{
  std::string text_of(const Tensor<1, 3> &v)
  {
    return std::to_string(v[0]) + ", " + std::to_string(v[1]) + ", " + std::to_string(v[2]);
  }


  /**
   * The disc in a lattice, turned with its field, whose exact displacement is that of the nodes;
   * its radius is that of 8.25 cells.
   */
  class DiscOnLattice
  {
  public:
    /** @param axes of the disc: x, y and the normal z */
    DiscOnLattice(const Tensor<2, 3> &axes, const std::string &cells, const Tensor<1, 3> &lower)
      : axes(axes)
      , body(Settings{{"Domain/Nodes", "cell centers"},
                      {"Domain/Lower corner", text_of(spacing * lower)},
                      {"Domain/Upper corner", text_of(spacing * upper_of(cells, lower))},
                      {"Domain/Cells", cells},
                      {"Material/Young modulus", std::to_string(young)},
                      {"Material/Poisson ratio", std::to_string(poisson)},
                      {"Peridynamics/Horizon ratio", "3"},
                      {"Cracks/Polygons", "disc: 0, 0, 0, " + text_of(axes[2]) + ", 1"},
                      {"Boundary conditions/Displacement", "left: 0, 0, 0"}},
             ModelKind::peridynamics,
             MPI_COMM_SELF)
    {}

    std::vector<StressIntensity> found(const double tension, const double shear) const
    {
      const auto u = [&](const unsigned int i, const unsigned int d) {
        return (transpose(axes) *
                disc(Point<3>(axes * Tensor<1, 3>(body.nodes->position(i))), tension, shear))[d];
      };
      return bond_intensities<3>(body.scene, body.states->bonds().families, u, false, 0., 0.);
    }

    /** From x to y along the front. */
    double angle_of(const StressIntensity &values) const
    {
      const Tensor<1, 3> p = axes * Tensor<1, 3>(*values.place);
      return std::atan2(p[1], p[0]);
    }

  private:
    static constexpr double spacing = 1. / 8.25;

    static Tensor<1, 3> upper_of(const std::string &cells, Tensor<1, 3> lower)
    {
      std::istringstream list(cells);
      char               comma;
      for (unsigned int d = 0; d < 3; ++d)
        {
          double n;
          list >> n >> comma;
          lower[d] += n;
        }
      return lower;
    }

    const Tensor<2, 3> axes;
    const Body<3>      body;
  };


  constexpr double widest_ring = 0.736; // over the radius


  /** Means of K_I, K_II, K_III and J about a place, with H of this half length. */
  std::array<double, 4> means_of_disc(const double angle,
                                      const double half,
                                      const double tension,
                                      const double shear)
  {
    const double root = std::sqrt(radius / pi), sheared = 4. * shear * root / (2. - poisson);
    constexpr unsigned int n = 1000;
    std::array<double, 4>  sums{};
    double                 all = 0.;
    for (unsigned int k = 0; k < n; ++k)
      {
        const double on = (2. * k + 1.) / n - 1., weight = smooth_step(std::abs(on));
        const double turned = angle + half * on;
        const double K[]    = {2. * tension * root,
                               sheared * std::cos(turned),
                               (1. - poisson) * sheared * std::sin(turned)};
        for (unsigned int m = 0; m < 3; ++m)
          sums[m] += weight * K[m];
        sums[3] += weight * ((1. - poisson * poisson) / young * (K[0] * K[0] + K[1] * K[1]) +
                             K[2] * K[2] / (2. * moduli.shear));
        all += weight;
      }
    for (double &sum : sums)
      sum /= all;
    return sums;
  }
} // namespace


TEST(FrontIntensity, disc_on_a_lattice)
{
  Tensor<2, 3> aligned, turned;
  for (unsigned int d = 0; d < 3; ++d)
    aligned[d][d] = 1.;
  turned[0]        = Tensor<1, 3>({0.8, 0.36, -0.48});
  turned[1]        = Tensor<1, 3>({0., 0.8, 0.6});
  turned[2]        = cross_product_3d(turned[0], turned[1]);
  const auto check = [](const DiscOnLattice &lattice,
                        const double         tension,
                        const double         shear,
                        const unsigned int   n_places) {
    const auto list = lattice.found(tension, shear);
    EXPECT_EQ(list.size(), n_places);
    for (const StressIntensity &values : list)
      {
        const auto mean = means_of_disc(lattice.angle_of(values), widest_ring, tension, shear);
        EXPECT_NEAR(values.mode_1, mean[0], 0.02) << values.name;
        EXPECT_NEAR(values.mode_2, mean[1], 0.02) << values.name;
        EXPECT_NEAR(*values.mode_3, mean[2], 0.02) << values.name;
        EXPECT_NEAR(std::sqrt(values.j / mean[3]), 1., 0.03) << values.name;
      }
  };
  const DiscOnLattice along(aligned, "24, 24, 16", Tensor<1, 3>({-9., -9., -8.}));
  check(along, 1., 0., 2);
  check(along, 0., 1., 2);
  check(DiscOnLattice(turned, "30, 30, 30", Tensor<1, 3>({-15.1, -14.8, -14.6})), 0.5, 1., 4);
}


TEST(FrontIntensity, weight_of_the_core)
{
  constexpr double       cell = 0.3;
  constexpr unsigned int n    = 10000;
  const CoreWeight       weight(cell), none(0.);
  EXPECT_EQ(weight(0.), 0.);
  EXPECT_EQ(none(0.), 1.);
  EXPECT_EQ(weight(5. * cell), 1.);
  double sums[2] = {0., 0.};
  for (unsigned int k = 0; k < n; ++k)
    {
      const double r = 5. * cell * (k + 0.5) / n, missing = weight(r) - 1.;
      sums[0] += missing / n;
      sums[1] += missing * r / n;
    }
  EXPECT_NEAR(sums[0], 0., 1e-6);
  EXPECT_NEAR(sums[1], 0., 1e-6);
}
