// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Correspondence blended with finite elements where the law is not linear: against correspondence
// alone, forces against energies and tangents, archives, bodies on any number of processes.

#include <perideal/base/archive.h>

#include <cmath>

#include "body_waves.h"
#include "elastic_coupling_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;
using dealii::Point;
using dealii::Tensor;

namespace
{
  template <int dim>
  Settings flowing(const std::string &zone, const std::string &plane = "strain")
  {
    return zoned<dim>(zone, 0.3, plane) + Settings{{"Coupling/Scheme", "blending"},
                                                   {"Coupling/Overlap", "1"},
                                                   {"Elasticity/Model", "correspondence"},
                                                   {"Peridynamics/Horizon ratio", "2"},
                                                   {"Peridynamics/Kernel exponent", "auto"},
                                                   {"Peridynamics/Operator form", "stored"},
                                                   {"Material/Law", "plastic"},
                                                   {"Material/Yield stress", "0.3"},
                                                   {"Material/Hardening modulus", "0.2"},
                                                   {"Elasticity/Solver", "newton"}};
  }

  const std::string half = "0.8 - x"; // of the body of zoned()

  /** Two steps in which the body flows. */
  template <int dim>
  void flow(const Body<dim> &body)
  {
    body.op().accept(waves(body, 0.02, 0.), 0.);
    body.op().accept(waves(body, 0.025, 0.2), 1.);
    EXPECT_GT(body.op().released().by_law, 0.);
  }


  template <int dim>
  void expect_correspondence(const std::string &plane)
  {
    SCOPED_TRACE(plane);
    const Settings  settings = flowing<dim>("everywhere", plane);
    const Body<dim> blended(settings, ModelKind::coupled), alone(settings, ModelKind::peridynamics);
    flow(blended);
    flow(alone);
    EXPECT_NEAR(blended.op().released().by_law / alone.op().released().by_law, 1., 1e-10);
    const Vector u = waves(blended, 0.03, 0.5), of_alone = waves(alone, 0.03, 0.5);
    const auto   expect_same = [](const Vector &a, const Vector &b) {
      EXPECT_LE(largest_difference(a, b), 1e-12 * a.linfty_norm());
    };
    expect_same(blended.unbalanced(u), alone.unbalanced(of_alone));
    EXPECT_NEAR(blended.op().energy(u) / alone.op().energy(of_alone), 1., 1e-12);
    blended.op().linearize(u);
    alone.op().linearize(of_alone);
    expect_same(blended.product(waves(blended, 1., 2.)), alone.product(waves(alone, 1., 2.)));
    EXPECT_EQ(blended.op().size().bonds, alone.op().size().bonds);
  }


  /** K is the slope of the forces, symmetric and positive; forces and moments balance. */
  template <int dim>
  void expect_tangent(const std::string &plane = "")
  {
    SCOPED_TRACE(plane);
    const Body<dim> body(flowing<dim>(half, plane), ModelKind::coupled);
    const Vector    small = waves(body, 1e-3, 0.5), direction = waves(body, 1., 2.),
                 other = waves(body, 1., 3.);
    Vector     above(direction), below(direction);
    const auto find_slopes = [&](const Vector &u, const double step) {
      Vector up(u), down(u);
      up.add(step, direction);
      down.add(-step, direction);
      body.op().unbalanced(above, up, 2.);
      body.op().unbalanced(below, down, 2.);
      const double energies = body.op().energy(up) - body.op().energy(down);
      above -= below;
      above *= -0.5 / step;
      return 0.5 * energies / step;
    };
    Vector forces(direction);
    body.op().unbalanced(forces, small, 2.);
    EXPECT_NEAR(find_slopes(small, 1e-7),
                -(forces * direction),
                1e-8 * forces.l2_norm() * direction.l2_norm());
    flow(body);
    const Vector u = waves(body, 0.03, 0.5);
    find_slopes(u, 1e-7);
    body.op().unbalanced(forces, u, 2.);
    body.op().linearize(u);
    const Vector image = body.product(direction), of_other = body.product(other);
    EXPECT_LT(largest_difference(above, image), 1e-6 * image.linfty_norm());
    EXPECT_NEAR(other * image, direction * of_other, 1e-12 * other.l2_norm() * image.l2_norm());
    EXPECT_GT(direction * image, 0.);
    for (const Vector &motion : body.elements->near_null_space())
      EXPECT_LT(std::abs(motion * forces), 1e-13 * motion.linfty_norm() * forces.l1_norm());
    const Spectrum spectrum = body.op().spectrum();
    EXPECT_LE(spectrum.sharp, spectrum.safe * (1. + 1e-12));
  }


  template <int dim>
  NodeKeys keys(const Body<dim> &body)
  {
    NodeKeys list;
    for (unsigned int i = 0; i < body.n_owned(); ++i)
      {
        std::uint64_t key = 0;
        for (unsigned int d = 0; d < dim; ++d)
          key = (key << 20) + std::llround(1e4 * (body.position(i)[d] + 1.));
        list.push_back(key);
      }
    return list;
  }
} // namespace


TEST(NodalZone, everywhere_is_correspondence)
{
  expect_correspondence<2>("stress");
  expect_correspondence<2>("strain");
}


TEST(NodalZone, forces_and_tangents)
{
  expect_tangent<2>("stress");
  expect_tangent<2>("strain");
  expect_tangent<3>();
}


/** Below the yield stress the body is that of the linear law, whose families stand in a matrix. */
TEST(NodalZone, is_the_linear_body_before_it_yields)
{
  const Settings linear{{"Material/Law", "linear"},
                        {"Material/Yield stress", ""},
                        {"Material/Hardening modulus", "0"}},
    high{{"Material/Yield stress", "100"}};
  for (const std::string plane : {"stress", "strain"})
    {
      const Body<2> a(flowing<2>(half, plane) + linear, ModelKind::coupled),
        b(flowing<2>(half, plane) + high, ModelKind::coupled);
      const Vector u = waves(a, 0.05, 0.), y = a.unbalanced(u);
      if (plane == "stress") // in plane strain dilatations are projected
        {
          EXPECT_LT(largest_difference(y, b.unbalanced(waves(b, 0.05, 0.))),
                    1e-12 * y.linfty_norm());
          EXPECT_NEAR(a.op().energy(u) / b.op().energy(waves(b, 0.05, 0.)), 1., 1e-12);
          EXPECT_LT(largest_difference(a.product(u), b.product(waves(b, 0.05, 0.))),
                    1e-12 * y.linfty_norm());
          EXPECT_LT(largest_difference(a.op().diagonal(), b.op().diagonal()), 1e-12);
        }
      EXPECT_EQ(a.op().size().bonds, b.op().size().bonds);
    }
}


TEST(NodalZone, archived_and_taken_up_again)
{
  const Settings settings = flowing<2>(half);
  const Body<2>  body(settings, ModelKind::coupled), resumed(settings, ModelKind::coupled);
  flow(body);
  MemoryArchive saved(MPI_COMM_WORLD);
  body.op().exchange(saved, keys(body));
  MemoryArchive loaded(saved, MPI_COMM_WORLD);
  resumed.op().exchange(loaded, keys(resumed));
  const Vector u = waves(body, 0.03, 0.6);
  EXPECT_EQ(largest_difference(body.unbalanced(u), resumed.unbalanced(u)), 0.);
  body.op().accept(u, 2.);
  resumed.op().accept(u, 2.);
  EXPECT_EQ(body.op().released().by_law, resumed.op().released().by_law);
}


TEST(NodalZone, same_on_all_processes)
{
  const Settings settings = flowing<2>(half);
  const Body<2>  together(settings, ModelKind::coupled),
    alone(settings, ModelKind::coupled, MPI_COMM_SELF);
  flow(together);
  flow(alone);
  EXPECT_NEAR(together.op().released().by_law / alone.op().released().by_law, 1., 1e-12);
  const Vector u = waves(together, 0.03, 0.5), of_alone = waves(alone, 0.03, 0.5);
  EXPECT_LE(difference(together, together.unbalanced(u), alone, alone.unbalanced(of_alone)), 1e-12);
  together.op().linearize(u);
  alone.op().linearize(of_alone);
  EXPECT_LE(difference(together,
                       together.product(waves(together, 1., 2.)),
                       alone,
                       alone.product(waves(alone, 1., 2.))),
            1e-12);
}
