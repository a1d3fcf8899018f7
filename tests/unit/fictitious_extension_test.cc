// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/operators/coupling/state_coupling.h>

#include <cmath>

#include "elastic_coupling_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;

namespace
{
  /** Peridynamics alone, families completed beyond the sides. */
  template <int dim>
  Settings completed(const double nu = 0.25)
  {
    return zoned<dim>("everywhere", nu) +
           Settings{{"Coupling/Scheme", "blending"},
                    {"Peridynamics/Surface correction", "fictitious nodes"}};
  }


  /** How many sides are within a distance of a node. */
  template <int dim>
  unsigned int n_sides_near(const Body<dim> &body, const unsigned int node, const double distance)
  {
    unsigned int n = 0;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double x = body.position(node)[d];
        n += (x < distance) + (x > body.scene.domain.upper[d] - distance);
      }
    return n;
  }


  /**
   * Forces of a uniform strain act on sides alone; those of equal strains in all directions are
   * those of the classical body where no other side is near, and have its energy.
   */
  template <int dim>
  void check_completed(const Settings &settings)
  {
    const Body<dim> body(settings, ModelKind::coupled);
    EXPECT_LT(asymmetry(body), 1e-14);
    EXPECT_LT(unbalanced(body), 1e-13);
    Matrix elements;
    body.elements->assemble_intact(elements, false);
    const double farthest = body.elements->bonds().families().weights().reach() + 1e-9;
    Vector       x        = body.values(
             [](const dealii::Point<dim> &p) -> dealii::Tensor<1, dim> { return 0.1 * p; }),
           y(x), z(x);
    body.elements->multiply(y, x);
    elements.vmult(z, x);
    EXPECT_NEAR((x * y) / (x * z), 1., 1e-12);
    const double largest    = z.linfty_norm();
    unsigned int n_compared = 0;
    for (unsigned int i = 0; i < y.locally_owned_size(); ++i)
      if (n_sides_near(body, i / dim, farthest) < 2)
        {
          EXPECT_NEAR(y.local_element(i), z.local_element(i), 1e-13 * largest);
          ++n_compared;
        }
    EXPECT_GT(sum_of_all(n_compared), 10u);
    x = body.values(linear_field<dim>);
    body.elements->multiply(y, x);
    const double size = y.linfty_norm();
    for (unsigned int i = 0; i < y.locally_owned_size(); ++i)
      if (n_sides_near(body, i / dim, 1e-9) == 0)
        {
          EXPECT_LT(std::abs(y.local_element(i)) / size, 1e-13);
        }
  }
} // namespace


TEST(FictitiousExtension, uniform_strains)
{
  check_completed<1>(completed<1>());
  for (const double nu : {-0.3, 0.25, 0.45})
    {
      check_completed<2>(completed<2>(nu));
      check_completed<2>(completed<2>(nu) + Settings{{"Elasticity/Plane", "strain"}});
      if (nu == 0.25 || n_processes() == 1)
        check_completed<3>(completed<3>(nu));
    }
  check_completed<2>(completed<2>() + Settings{{"Domain/Upper corner", "1.4, 1.8"}});
}


TEST(FictitiousExtension, plane_of_symmetry)
{
  const Settings both =
                   completed<2>() + Settings{{"Boundary conditions/Displacement", "right: 0, 0"},
                                             {"Material/Thermal expansion", "0.001"},
                                             {"Elasticity/Temperature change", "3 + x*x"}},
                 half = both + Settings{{"Boundary conditions/Symmetry", "left"}},
                 whole =
                   both + Settings{{"Domain/Lower corner", "-1.4, 0"}, {"Domain/Cells", "28, 12"}};
  const auto field = [](const dealii::Point<2> &p) -> dealii::Tensor<1, 2> {
    return dealii::Tensor<1, 2>(
      {std::sin(2. * p[0]) * (1. + p[1]), std::cos(3. * p[0]) * p[1] * p[1]});
  };
  const Body<2> a(half, ModelKind::coupled, MPI_COMM_SELF),
    b(whole, ModelKind::coupled, MPI_COMM_SELF);
  EXPECT_LE(difference(a, a.unbalanced(a.values(field)), b, b.unbalanced(b.values(field)), 0.01),
            1e-12);
  EXPECT_EQ(a.n_owned(), 15u * 13);
}


TEST(FictitiousExtension, free_thermal_expansion)
{
  const Body<2> body(completed<2>() + Settings{{"Material/Thermal expansion", "0.001"},
                                               {"Elasticity/Temperature change", "10"}},
                     ModelKind::coupled);
  expect_free_expansion(body, 0.01, 1e-14);
}
