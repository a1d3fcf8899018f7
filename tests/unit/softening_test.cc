// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Bonds that soften: the curve, what a row bears and dissipates as it opens, bonds that are pressed
// again, archives.

#include <perideal/base/archive.h>
#include <perideal/laws/gauss_rule.h>
#include <perideal/laws/softening_curve.h>

#include <algorithm>
#include <cmath>

#include "elastic_test_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;
using dealii::Point;
using dealii::Tensor;

namespace
{
  constexpr double strength = 3.9, energy = 0.1432, young = 37000.;

  /** Concrete, N and mm, in a box of cells of edge 1. */
  template <int dim>
  Settings concrete(const std::string &more_than_dim)
  {
    const char *const lower[] = {"", "0", "0, 0", "0, 0, 0"};
    const char *const upper[] = {"", "32", "32, 32", "16, 16, 16"};
    return {{"Domain/Lower corner", lower[dim]},
            {"Domain/Upper corner", upper[dim]},
            {"Domain/Cells", upper[dim]},
            {"Domain/Nodes", "cell centers"},
            {"Elasticity/Model", more_than_dim},
            {"Elasticity/Solver", "dynamics"},
            {"Peridynamics/Surface correction", "none"},
            {"Material/Young modulus", std::to_string(young)},
            {"Material/Density", "1"},
            {"Material/Law", "softening"},
            {"Material/Tensile strength", std::to_string(strength)},
            {"Material/Fracture energy", std::to_string(energy)}};
  }


  /** How a row across n opens: largest stress, and the area under stress over opening. */
  struct Opening
  {
    double peak = 0., area = 0.;
  };

  template <int dim>
  Opening open_row(const Settings &settings, Tensor<1, dim> n)
  {
    constexpr unsigned int n_steps = 400;
    const Body<dim>        body(settings, ModelKind::peridynamics);
    n /= n.norm();
    Point<dim> middle;
    for (unsigned int d = 0; d < dim; ++d)
      middle[d] = dim == 3 ? 8. : 16.;
    // Halves move apart as rigid bodies. Forces are those of what lies behind a piece of the plane.
    // As many nodes as there are cells in its width.
    const double half_width = dim == 3 ? 3. : n[0] * n[1 % dim] == 0. ? 6. : 4. * std::sqrt(2.);
    const double area       = std::pow(2. * half_width, dim - 1);
    const auto   behind     = [&](const Point<dim> &p) {
      const Tensor<1, dim> x     = p - middle;
      const Tensor<1, dim> along = x - (x * n) * n;
      if (!(x * n > 1e-9))
        return false;
      if (dim == 2)
        {
          const double s = n[0] * x[1 % dim] - n[1 % dim] * x[0];
          return s > -half_width + 1e-9 && s < half_width + 1e-9;
        }
      return std::abs(along[0]) < half_width && std::abs(along[1 % dim]) < half_width;
    };
    Opening found;
    double  opening = 0., last = 0.;
    for (unsigned int k = 1; k <= n_steps; ++k)
      {
        const double next = 10. * energy / strength * std::pow(static_cast<double>(k) / n_steps, 3);
        const Vector u    = body.values([&](const Point<dim> &p) {
          return (p - middle) * n > 1e-9 ? next * n : Tensor<1, dim>();
        });
        while (body.op().break_bonds(u, k, 0.) > 0)
          ;
        const Vector r     = body.unbalanced(u);
        double       force = 0.;
        for (unsigned int i = 0; i < body.n_owned(); ++i)
          if (behind(body.position(i)))
            for (unsigned int d = 0; d < dim; ++d)
              force -= r.local_element(dim * i + d) * n[d];
        const double stress = dealii::Utilities::MPI::sum(force, MPI_COMM_WORLD) / area;
        found.peak          = std::max(found.peak, stress);
        found.area += 0.5 * (stress + last) * (next - opening);
        opening = next;
        last    = stress;
      }
    return found;
  }


  template <int dim>
  Tensor<1, dim> axis(const unsigned int d)
  {
    Tensor<1, dim> n;
    n[d] = 1.;
    return n;
  }
} // namespace


TEST(Softening, curves_have_area_one)
{
  const GaussRule rule(5);
  for (const Softening kind : {Softening::linear, Softening::bilinear, Softening::exponential})
    {
      const SofteningCurve curve(kind);
      double               area = 0.;
      for (unsigned int k = 0; k < 1000; ++k)
        area += rule.integrate(0.01 * k, 0.01 * (k + 1), [&](const double z) { return curve(z); });
      EXPECT_NEAR(area, 1., 2e-4);
      EXPECT_EQ(curve(0.), 1.);
      EXPECT_EQ(curve(SofteningCurve::longest), 0.);
    }
}


TEST(Softening, onset_and_energy_of_a_row)
{
  const Settings third{{"Material/Poisson ratio", "0.3333333333333333"}};
  {
    const Body<2> body(concrete<2>("bond-based") + third +
                         Settings{{"Peridynamics/Horizon ratio", "3"}},
                       ModelKind::peridynamics);
    EXPECT_NEAR(body.states->breaking().critical_stretches()[0] * young / strength, 2. / 3., 1e-9);
  }
  Tensor<1, 2> diagonal = axis<2>(0);
  diagonal[1]           = 1.;
  for (const char *const m : {"3", "4"})
    for (const char *const curve : {"exponential", "linear", "bilinear"})
      {
        if (*m == '4' && curve[0] != 'e')
          continue; // of tails m knows nothing
        const Settings settings =
          concrete<2>("bond-based") + third +
          Settings{{"Peridynamics/Horizon ratio", m}, {"Material/Softening", curve}};
        const Opening straight = open_row<2>(settings, axis<2>(1)),
                      oblique  = open_row<2>(settings, diagonal);
        EXPECT_NEAR(straight.area, energy, 0.003 * energy) << curve << ", m = " << m;
        EXPECT_NEAR(oblique.area, energy, 0.016 * energy) << curve << ", m = " << m;
        EXPECT_NEAR(straight.peak, strength, 0.02 * strength) << curve << ", m = " << m;
        EXPECT_NEAR(oblique.peak, strength, 0.02 * strength) << curve << ", m = " << m;
      }
  for (const char *const plane : {"stress", "strain"})
    for (const char *const nu : {"0.1", "0.35"})
      {
        const Opening found =
          open_row<2>(concrete<2>("state-based") + Settings{{"Material/Poisson ratio", nu},
                                                            {"Elasticity/Plane", plane},
                                                            {"Peridynamics/Horizon ratio", "3"}},
                      axis<2>(0));
        EXPECT_NEAR(found.area, energy, 0.003 * energy) << plane << ", nu = " << nu;
        EXPECT_NEAR(found.peak, strength, 0.05 * strength) << plane << ", nu = " << nu;
      }
  const Opening solid =
    open_row<3>(concrete<3>("state-based") +
                  Settings{{"Material/Poisson ratio", "0.2"}, {"Peridynamics/Horizon ratio", "2"}},
                axis<3>(2));
  EXPECT_NEAR(solid.area, energy, 0.003 * energy);
  EXPECT_NEAR(solid.peak, strength, 0.05 * strength);
}
