// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <perideal/laws/elasticity.h>
#include <perideal/solvers/linear_solver.h>

#include <cmath>

#include "elastic_test_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;

namespace
{
  template <int dim>
  dealii::Tensor<1, dim> linear_field(const dealii::Point<dim> &p)
  {
    return some_gradient<dim>() * p;
  }


  template <int dim>
  Settings zoned(const std::string &zone, const double nu, const std::string &plane = "stress")
  {
    const char *const corners[] = {"", "1.6", "1.4, 1.2", "0.8, 0.7, 0.6"};
    const char *const counts[]  = {"", "16", "14, 12", "8, 7, 6"};
    Settings          settings  = box<dim>() + Settings{{"Domain/Upper corner", corners[dim]},
                                              {"Domain/Cells", counts[dim]},
                                              {"Material/Poisson ratio", std::to_string(nu)},
                                              {"Coupling/Zone", zone}};
    if (dim == 2)
      settings.push_back({"Elasticity/Plane", plane});
    return settings;
  }


  /** Linear patch, symmetry, momentum and moment of momentum, positive remainders. */
  template <int dim>
  void check_patch(const Settings &settings)
  {
    const Body<dim>                        body(settings, Model::coupled);
    dealii::TrilinosWrappers::SparseMatrix with, without;
    body.elements->assemble_intact(with, true);
    body.elements->assemble_intact(without, false);
    Vector x = body.values(linear_field<dim>), y(x), z(x);
    with.vmult(y, x);
    without.vmult(z, x);
    const double size = z.linfty_norm();
    y -= z;
    EXPECT_LT(y.linfty_norm() / size, 1e-12);

    x = body.values(bumpy_vector<dim>);
    with.vmult(y, x);
    with.Tvmult(z, x);
    z -= y;
    EXPECT_LT(z.linfty_norm() / y.linfty_norm(), 1e-13);

    for (const Vector &motion : body.elements->near_null_space())
      EXPECT_LT(std::abs(motion * y) / (motion.linfty_norm() * y.l1_norm()), 1e-13);
    EXPECT_GT(body.elements->lowest_remainder(), -1e-12);
  }
} // namespace


TEST(ElasticExchange, linear_patch)
{
  check_patch<1>(zoned<1>("x - 0.75", 0.));
  check_patch<1>(zoned<1>("everywhere", 0.));
  for (const std::string zone :
       {"everywhere", "0.16 - (x-0.6)^2 - (y-0.5)^2", "x - 0.75", "sin(50*x)*sin(70*y+1)"})
    {
      for (const double nu : {-0.3, 0., 0.2, 1. / 3., 0.45})
        check_patch<2>(zoned<2>(zone, nu));
      for (const double nu : {-0.3, 0., 0.25, 0.45})
        check_patch<2>(zoned<2>(zone, nu, "strain"));
    }
  for (const std::string zone : {"everywhere", "x - 0.35", "sin(50*x)*sin(70*y+1) + z - 0.3"})
    for (const double nu : {-0.2, 0.25, 0.45})
      check_patch<3>(zoned<3>(zone, nu));
}


TEST(ElasticExchange, linear_patch_on_rectangles)
{
  check_patch<2>(zoned<2>("x - 0.75", 0.3) + Settings{{"Domain/Upper corner", "1.4, 1.8"}});
  check_patch<3>(zoned<3>("x - 0.35", 0.3) + Settings{{"Domain/Upper corner", "0.8, 0.84, 0.66"}});
}


TEST(ElasticExchange, layers_stay_exact)
{
  // Two phases in series: the strain jumps at the interface, across which no bond is active.
  const Settings layers =
    zoned<2>("everywhere", 0.) + Settings{{"Material/Young modulus", "3"},
                                          {"Material/Phases/Regions", "stiff: x > 0.7"},
                                          {"Material/Phases/Young modulus", "stiff: 30"}};
  const Body<2>                          body(layers, Model::coupled);
  dealii::TrilinosWrappers::SparseMatrix with;
  body.elements->assemble_intact(with, true);
  Vector y, x = body.values([](const dealii::Point<2> &p) {
    return dealii::Tensor<1, 2>({p[0] < 0.7 ? p[0] : 0.7 + 0.1 * (p[0] - 0.7), 0.});
  });
  body.elements->initialize_vector(y);
  with.vmult(y, x);
  for (unsigned int i = 0; i < y.locally_owned_size() / 2; ++i)
    if (body.elements->position(i)[0] > 0.01 && body.elements->position(i)[0] < 1.39)
      {
        EXPECT_NEAR(y.local_element(2 * i), 0., 1e-12);
      }
}


TEST(ElasticExchange, free_thermal_expansion)
{
  const auto check = [](const Settings &settings, auto dimension) {
    constexpr int dim = decltype(dimension)::value;
    Body<dim>     body(settings, Model::coupled);
    const double  strain =
      0.01 *
      (settings.back().second == "strain" ? 1.3 : 1.); // alpha dT, in plane strain times 1 + nu
    Vector u = body.values([&](const dealii::Point<dim> &p) {
      dealii::Tensor<1, dim> value = strain * p;
      return value;
    });
    Vector r;
    body.elements->initialize_vector(r);
    body.elements->residual(r, u, 0.);
    EXPECT_LT(r.linfty_norm(), 1e-13);
    EXPECT_NEAR(body.elements->energy(u), 0., 1e-14);
  };
  const Settings warm{{"Material/Thermal expansion", "0.001"},
                      {"Elasticity/Temperature change", "10"}};
  check(zoned<2>("x - 0.7", 0.3) + warm, std::integral_constant<int, 2>());
  check(zoned<2>("x - 0.7", 0.3) + warm + Settings{{"Elasticity/Plane", "strain"}},
        std::integral_constant<int, 2>());
  check(zoned<3>("x - 0.3", 0.2) + warm, std::integral_constant<int, 3>());
}


TEST(ElasticExchange, same_on_all_processes)
{
  const Settings settings =
    zoned<2>("cracks: 1", 0.3) + Settings{{"Cracks/Segments", "0.4, 0.55 ; 1.0, 0.75"},
                                          {"Peridynamics/Surface correction", "crack scaling"}};
  const Body<2> together(settings, Model::coupled), alone(settings, Model::coupled, MPI_COMM_SELF);
  Vector x = together.values(bumpy_vector<2>), y(x), x1 = alone.values(bumpy_vector<2>), y1(x1);
  together.elements->multiply(y, x);
  alone.elements->multiply(y1, x1);
  unsigned int n_compared = 0;
  for (unsigned int i = 0; i < y.locally_owned_size(); ++i)
    for (unsigned int k = 0; k < y1.locally_owned_size() / 2; ++k)
      if (together.elements->position(i / 2).distance(alone.elements->position(k)) < 1e-9)
        {
          EXPECT_NEAR(y.local_element(i), y1.local_element(2 * k + i % 2), 1e-12);
          ++n_compared;
        }
  EXPECT_EQ(n_compared, y.locally_owned_size());
  EXPECT_EQ(together.elements->size().bonds, alone.elements->size().bonds);
}
