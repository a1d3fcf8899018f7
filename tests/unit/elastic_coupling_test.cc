// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <perideal/analysis/coupling_certificate.h>
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


  void expect_same_on_all_processes(const Settings &settings)
  {
    const Body<2> together(settings, Model::coupled),
      alone(settings, Model::coupled, MPI_COMM_SELF);
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
  expect_same_on_all_processes(zoned<2>("cracks: 1", 0.3) +
                               Settings{{"Cracks/Segments", "0.4, 0.55 ; 1.0, 0.75"},
                                        {"Peridynamics/Surface correction", "crack scaling"}});
}


namespace
{
  using Matrix = dealii::TrilinosWrappers::SparseMatrix;

  const std::vector<std::string> schemes{"splice", "blending"};


  /** A block in the middle, with its overlap of half a horizon more than two horizons of 0.2 clear of the surface. */
  template <int dim>
  Settings block(const std::string &scheme, const std::string &overlap = "0")
  {
    const std::string half    = overlap == "0" ? "0.15" : "0.05";
    const std::string zones[] = {"",
                                 half + " - abs(x-0.8)",
                                 half + " - max(abs(x-0.7), abs(y-0.6))"};
    return zoned<dim>(zones[dim], 0.25) + Settings{{"Peridynamics/Horizon ratio", "2"},
                                                   {"Coupling/Scheme", scheme},
                                                   {"Coupling/Overlap", overlap}};
  }


  /** Of a field, |(K - K of finite elements) u| over the largest of the latter. */
  template <int dim, typename Field>
  double defect(const Body<dim> &body, const Field &field)
  {
    Matrix with, without;
    body.elements->assemble_intact(with, true);
    body.elements->assemble_intact(without, false);
    Vector x = body.values(field), y(x), z(x);
    with.vmult(y, x);
    without.vmult(z, x);
    const double size = z.linfty_norm();
    z -= y;
    return z.linfty_norm() / size;
  }


  template <int dim>
  double asymmetry(const Body<dim> &body)
  {
    Matrix matrix;
    body.elements->assemble_intact(matrix, true);
    Vector x = body.values(bumpy_vector<dim>), y(x), z(x);
    matrix.vmult(y, x);
    matrix.Tvmult(z, x);
    z -= y;
    return z.linfty_norm() / y.linfty_norm();
  }


  /** Largest |m . K x| over max |m| sum |K x| for the rigid motions m. */
  template <int dim>
  double unbalanced(const Body<dim> &body)
  {
    Matrix matrix;
    body.elements->assemble_intact(matrix, true);
    Vector x = body.values(bumpy_vector<dim>), y(x);
    matrix.vmult(y, x);
    double largest = 0.;
    for (const Vector &motion : body.elements->near_null_space())
      largest = std::max(largest, std::abs(motion * y) / (motion.linfty_norm() * y.l1_norm()));
    return largest;
  }


  /** With peridynamics everywhere both schemes are the operator of peridynamics, heat and cracks included. */
  template <int dim>
  void expect_peridynamics(const std::string &scheme, const std::string &model)
  {
    Settings settings = zoned<dim>("everywhere", dim == 1 ? 0. : 0.4) +
                        Settings{{"Coupling/Scheme", scheme},
                                 {"Elasticity/Model", model},
                                 {"Material/Thermal expansion", "0.001"},
                                 {"Elasticity/Temperature change", "3 + x*x + 2*x"}};
    if (dim == 2)
      settings = settings + Settings{{"Cracks/Segments", "0.43, 0.55 ; 1.01, 0.75"}};
    const Body<dim> coupled(settings, Model::coupled), alone(settings, Model::peridynamics);
    Vector          x = coupled.values(bumpy_vector<dim>), y(x), z(x);
    coupled.op().multiply(y, x);
    alone.op().multiply(z, x);
    const double size = z.linfty_norm();
    z -= y;
    EXPECT_LT(z.linfty_norm() / size, 1e-13) << scheme << ", " << model << ", " << dim << "D";
    coupled.op().unbalanced(y, x, 0.);
    alone.op().unbalanced(z, x, 0.);
    z -= y;
    EXPECT_LT(z.linfty_norm() / size, 1e-13) << scheme << ", " << model << ", " << dim << "D";
    EXPECT_NEAR(coupled.op().energy(x) / alone.op().energy(x), 1., 1e-12);
    EXPECT_EQ(coupled.op().size().bonds, alone.op().size().bonds);
  }
} // namespace


TEST(StateCouplings, everywhere_is_peridynamics)
{
  for (const std::string &scheme : schemes)
    for (const std::string model : {"state-based", "bond-based"})
      {
        expect_peridynamics<1>(scheme, model);
        expect_peridynamics<2>(scheme, model);
        expect_peridynamics<3>(scheme, model);
      }
}


TEST(StateCouplings, splice_is_exact_for_linear_fields_but_does_not_balance)
{
  for (const std::string overlap : {"0", "0.5"})
    {
      const Body<1> bar(block<1>("splice", overlap), Model::coupled);
      const Body<2> plate(block<2>("splice", overlap), Model::coupled);
      EXPECT_LT(defect(bar, linear_field<1>), 1e-13);
      EXPECT_LT(defect(plate, linear_field<2>), 1e-13);
      EXPECT_FALSE(plate.elements->symmetric());
      EXPECT_GT(asymmetry(plate), 1e-3);
      EXPECT_GT(unbalanced(plate), 1e-4);
    }
}


TEST(StateCouplings, blending_balances_but_is_not_exact)
{
  for (const std::string overlap : {"0", "0.5", "1"})
    {
      const Body<2> plate(block<2>("blending", overlap), Model::coupled);
      EXPECT_TRUE(plate.elements->symmetric());
      EXPECT_LT(asymmetry(plate), 1e-14);
      EXPECT_LT(unbalanced(plate), 1e-14);
      const double linear = defect(plate, linear_field<2>);
      EXPECT_GT(linear, 1e-4);
      EXPECT_LT(linear, 1.);
      EXPECT_GE(plate.elements->lowest_remainder(), -1e-14);
    }
}


/** The certificate says the same. */
TEST(StateCouplings, certificates)
{
  for (const std::string scheme : {"exchange", "splice", "blending"})
    {
      const Body<2>             plate(block<2>(scheme), Model::coupled);
      const CouplingCertificate found = examine_coupling(*plate.elements);
      EXPECT_EQ(found.linear < 1e-12, scheme != "blending") << scheme << ": " << found.linear;
      EXPECT_EQ(found.asymmetry < 1e-13, scheme != "splice") << scheme << ": " << found.asymmetry;
      EXPECT_EQ(*found.unbalanced < 1e-13, scheme != "splice")
        << scheme << ": " << *found.unbalanced;
      EXPECT_EQ(found.fault().empty(), scheme == "exchange") << found.fault();
      EXPECT_GT(found.lowest_eigenvalue, 0.);
      EXPECT_GT(found.quadratic, 1e-7);
      EXPECT_LT(found.quadratic, 0.02);
      EXPECT_LT(found.cubic, 0.02);
    }
}


TEST(StateCouplings, free_thermal_expansion)
{
  for (const std::string &scheme : schemes)
    {
      const Settings warm{{"Material/Thermal expansion", "0.001"},
                          {"Elasticity/Temperature change", "10"}};
      const Body<2>  body(block<2>(scheme, "0.5") + warm, Model::coupled);
      Vector         u =
        body.values([](const dealii::Point<2> &p) -> dealii::Tensor<1, 2> { return 0.01 * p; });
      Vector r(u);
      body.elements->residual(r, u, 0.);
      EXPECT_LT(r.linfty_norm(), 1e-14) << scheme;
      EXPECT_NEAR(body.elements->energy(u), 0., 1e-15) << scheme;
    }
}


TEST(StateCouplings, same_on_all_processes)
{
  for (const std::string &scheme : schemes)
    {
      const Settings settings =
        zoned<2>("cracks: 1", 0.3) + Settings{{"Cracks/Segments", "0.4, 0.55 ; 1.0, 0.75"},
                                              {"Coupling/Scheme", scheme},
                                              {"Coupling/Overlap", "1"}};
      expect_same_on_all_processes(settings);
    }
}
