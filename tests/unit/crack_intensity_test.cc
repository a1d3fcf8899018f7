// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Integrals over rings about ends of cracks, with fields that are known, and what families of
// nodes make of fields.

#include <perideal/analysis/bond_intensities.h>
#include <perideal/analysis/stress_intensity.h>
#include <perideal/laws/elasticity.h>

#include <cmath>

#include "operator_test_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;

namespace
{
  using dealii::Point;
  using dealii::Tensor;

  const double     pi = std::acos(-1.), young = 3., poisson = 0.3;
  constexpr double K_I = 1.3, K_II = -0.7;


  /** A plane body with fields that leave the faces of a crack along x < 0 without traction. */
  struct CrackedBody
  {
    PlaneState plane;
    Moduli     moduli = moduli_from(Modulus::young, young, Modulus::poisson, poisson);
    bool       warm = false, heavy = false;

    double in_plane_young() const
    {
      return plane == PlaneState::stress ? young : young / (1. - poisson * poisson);
    }

    double in_plane_poisson() const
    {
      return plane == PlaneState::stress ? poisson : poisson / (1. - poisson);
    }

    /** The near-tip field (Irwin); what a linear temperature and a weight along x add. */
    Tensor<1, 2> displacement(const Point<2> &p) const
    {
      const double r = p.norm(), angle = std::atan2(p[1], p[0]);
      const double s = std::sin(0.5 * angle), c = std::cos(0.5 * angle);
      const double kappa  = plane == PlaneState::stress ? (3. - poisson) / (1. + poisson) :
                                                          3. - 4. * poisson;
      const double factor = std::sqrt(r / (2. * pi)) / (2. * moduli.shear);
      Tensor<1, 2> u;
      u[0] = factor * (K_I * c * (kappa - 1. + 2. * s * s) + K_II * s * (kappa + 1. + 2. * c * c));
      u[1] = factor * (K_I * s * (kappa + 1. - 2. * c * c) - K_II * c * (kappa - 1. - 2. * s * s));
      if (warm)
        u += Tensor<1, 2>({0.5 * slope[0] * (p[0] * p[0] - p[1] * p[1]) + slope[1] * p[0] * p[1],
                           0.5 * slope[1] * (p[1] * p[1] - p[0] * p[0]) + slope[0] * p[0] * p[1]});
      if (heavy)
        u += Tensor<1, 2>({-0.5 * (p[0] * p[0] + in_plane_poisson() * p[1] * p[1]),
                           in_plane_poisson() * p[0] * p[1]}) *
             weight / in_plane_young();
      return u;
    }

    RingPoint<2> at(const Point<2> &p, const double area) const
    {
      constexpr double h = 1e-5;
      RingPoint<2>     point;
      point.place  = p;
      point.weight = area;
      for (unsigned int d = 0; d < 2; ++d)
        {
          Point<2> before = p, behind = p;
          before[d] -= h;
          behind[d] += h;
          const Tensor<1, 2> change = displacement(behind) - displacement(before);
          for (unsigned int i = 0; i < 2; ++i)
            point.gradient[i][d] = change[i] / (2. * h);
        }
      if (warm)
        {
          point.thermal_strain = slope * p;
          point.thermal_slope  = slope;
        }
      if (heavy)
        point.force[0] = weight;
      return point;
    }

    const Tensor<1, 2> slope{{0.6, -0.4}};
    const double       weight = 0.8;
  };


  StressIntensity found_of(const CrackedBody &body)
  {
    CrackEndIntegral
      end("end", Point<2>(), Tensor<1, 2>({1., 0.}), 0.2, 0.5, 0.05, body.moduli, body.plane);
    constexpr unsigned int n_rings = 200, n_rays = 400;
    for (unsigned int k = 0; k < n_rings; ++k)
      for (unsigned int l = 0; l < n_rays; ++l)
        {
          const double r     = 0.5 * (k + 0.5) / n_rings;
          const double angle = -pi + 2. * pi * (l + 0.5) / n_rays;
          end.add(body.at(Point<2>(r * std::cos(angle), r * std::sin(angle)),
                          0.5 / n_rings * r * 2. * pi / n_rays));
        }
    return end.result(MPI_COMM_SELF);
  }


  const Settings cracked{{"Domain/Lower corner", "-1, -1"},
                         {"Domain/Upper corner", "1, 1"},
                         {"Domain/Cells", "16, 16"},
                         {"Cracks/Segments", "-0.4,0.02 ; 0.5,0.02"},
                         {"Boundary conditions/Dirichlet", "left: 1"}};
} // namespace


TEST(CrackIntensity, heat_and_weight_that_load_no_crack)
{
  for (const PlaneState plane : {PlaneState::stress, PlaneState::strain})
    for (const bool warm : {false, true})
      for (const bool heavy : {false, true})
        {
          CrackedBody body{plane};
          body.warm                   = warm;
          body.heavy                  = heavy;
          const StressIntensity found = found_of(body);
          EXPECT_NEAR(found.mode_1, K_I, 2e-4) << warm << heavy;
          EXPECT_NEAR(found.mode_2, K_II, 2e-4) << warm << heavy;
          EXPECT_NEAR(found.j, (K_I * K_I + K_II * K_II) / body.in_plane_young(), 2e-4)
            << warm << heavy;
        }
}


TEST(CrackIntensity, nodes_on_the_crack_have_one_side)
{
  const Moduli moduli = moduli_from(Modulus::young, young, Modulus::poisson, poisson);
  const auto   j_of = [&](const int on_line, const double y, const std::optional<Point<2>> &node) {
    CrackEndIntegral end("end",
                         Point<2>(),
                         Tensor<1, 2>({1., 0.}),
                         0.2,
                         0.5,
                         0.05,
                         moduli,
                         PlaneState::stress,
                         on_line);
    RingPoint<2>     point;
    point.place          = Point<2>(-0.3, y);
    point.weight         = 1.;
    point.gradient[0][0] = 1.;
    point.node           = node;
    end.add(point);
    return end.result(MPI_COMM_SELF).mode_2;
  };
  const double left  = j_of(1, 1e-13, Point<2>(-0.31, 0.01)),
               right = j_of(1, -1e-13, Point<2>(-0.31, -0.01));
  EXPECT_LT(left * right, 0.);
  // What a node on the crack stands for below it is taken on its own side.
  EXPECT_NEAR(j_of(1, -0.02, Point<2>(-0.31, 0.)), left, 1e-9 * std::abs(left));
  EXPECT_NEAR(j_of(-1, 0.02, Point<2>(-0.31, 0.)), right, 1e-9 * std::abs(left));
  EXPECT_NEAR(j_of(1, -0.02, Point<2>(-0.31, 0.01)), left, 1e-9 * std::abs(left));
  EXPECT_NE(j_of(1, 0.02, Point<2>(-0.31, 0.)), left);
  // There no stress crosses the line of the crack, whatever the gradient says.
  EXPECT_NE(j_of(1, 1e-13, {}), left);
}


TEST(CrackIntensity, families_know_cubic_fields_beside_a_crack)
{
  const auto field = [](const Point<2> &p) {
    const double side = p[1] > 0.02 && p[0] > -0.5 && p[0] < 0.45 ? 1. : 0.;
    return side + p[0] * p[0] * p[0] - 2. * p[0] * p[1] * p[1] + 3. * p[0] * p[1] + p[1];
  };
  const auto slope = [](const Point<2> &p) {
    return Tensor<1, 2>(
      {3. * p[0] * p[0] - 2. * p[1] * p[1] + 3. * p[1], -4. * p[0] * p[1] + 3. * p[0] + 1.});
  };
  for (const char *nodes_at : {"vertices", "cell centers"})
    {
      const Problem<2>   problem(cracked + Settings{{"Domain/Nodes", nodes_at},
                                                  {"Peridynamics/Horizon ratio", "3"},
                                                  {"Peridynamics/Boundary treatment", "none"}});
      const auto        &families = bonds_of(problem.op()).diffusion_bonds().families();
      const Nodes<2>    &nodes    = families.nodes();
      FamilyFit<2>       fit(families);
      unsigned long long n_beside = 0;
      for (unsigned int i = 0; i < nodes.n_owned(); ++i)
        {
          const Point<2> &p = nodes.position(i);
          // Those that see the crack, but none of its ends.
          if (std::abs(p[1]) > 0.3 || std::abs(p[0] - 0.05) > 0.05)
            continue;
          ++n_beside;
          fit.fit(i, 1, [&](const unsigned int j, const unsigned int) {
            return field(nodes.position(j));
          });
          EXPECT_EQ(fit.degree(), 3u) << p;
          const Tensor<1, 2> away({0.05, p[1] > 0.02 ? 0.03 : -0.03}); // not across
          EXPECT_LT((fit.slope(0, away) - slope(p + away)).norm(), 1e-10) << p;
          EXPECT_NEAR(fit.value(0, away), field(p + away), 1e-10) << p;
        }
      EXPECT_GE(sum_of_all(n_beside), 4u);
    }
}
