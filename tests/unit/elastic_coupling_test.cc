// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <perideal/laws/elasticity.h>
#include <perideal/operators/elastic_elements.h>
#include <perideal/solvers/linear_solver.h>

#include <cmath>

#include "operator_test_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;

namespace
{
  /** An elastic body in the model `coupled`. */
  template <int dim>
  struct CoupledBody
  {
    explicit CoupledBody(const Settings &settings, const MPI_Comm communicator = MPI_COMM_WORLD)
    {
      scene.general.set("Models", "coupled");
      scene.general.set("Physics", "elasticity");
      set(scene, settings);
      std::vector<std::string> notes;
      mesh = build_mesh(scene, communicator, notes);
      handler.reinit(*mesh);
      handler.distribute_dofs(dealii::FE_Q<dim>(1));
      number_along_lattice(handler, scene.domain);
      nodes =
        std::make_unique<Nodes<dim>>(handler, scene.domain, scene.cracks, NodalVolume::partial);
      op = std::make_unique<ElasticElements<dim>>(handler,
                                                  scene,
                                                  make_elastic_coupling(*nodes, scene));
    }

    template <typename Function>
    Vector values(const Function &f) const
    {
      Vector v;
      op->initialize_vector(v);
      for (unsigned int i = 0; i < v.locally_owned_size() / dim; ++i)
        {
          const dealii::Tensor<1, dim> value = f(op->position(i));
          for (unsigned int d = 0; d < dim; ++d)
            v.local_element(dim * i + d) = value[d];
        }
      return v;
    }

    Scene<dim>                                  scene;
    std::unique_ptr<dealii::Triangulation<dim>> mesh;
    dealii::DoFHandler<dim>                     handler;
    std::unique_ptr<Nodes<dim>>                 nodes;
    std::unique_ptr<ElasticElements<dim>>       op;
  };


  template <int dim>
  dealii::Tensor<1, dim> linear_field(const dealii::Point<dim> &p)
  {
    const double           g[9] = {0.3, -0.2, 0.15, 0.45, -0.1, 0.25, -0.35, 0.2, 0.4};
    dealii::Tensor<1, dim> u;
    for (unsigned int a = 0; a < dim; ++a)
      for (unsigned int b = 0; b < dim; ++b)
        u[a] += g[3 * a + b] * p[b];
    return u;
  }


  template <int dim>
  dealii::Tensor<1, dim> bumps(const dealii::Point<dim> &p)
  {
    dealii::Tensor<1, dim> u;
    for (unsigned int a = 0; a < dim; ++a)
      u[a] = std::sin(3. * p[0] + 2. * a) + (dim > 1 ? std::cos(5. * p[dim - 1] - a) : 0.);
    return u;
  }


  const char *const cells[]   = {"", "16", "14, 12", "8, 7, 6"};
  const char *const corners[] = {"", "1.6", "1.4, 1.2", "0.8, 0.7, 0.6"};
  const char *const zeros[]   = {"", "0", "0, 0", "0, 0, 0"};


  template <int dim>
  Settings box(const std::string &zone, const double nu, const std::string &plane = "stress")
  {
    Settings settings{{"Domain/Lower corner", zeros[dim]},
                      {"Domain/Upper corner", corners[dim]},
                      {"Domain/Cells", cells[dim]},
                      {"Peridynamics/Horizon ratio", dim == 3 ? "2" : "3"},
                      {"Material/Young modulus", "3"},
                      {"Material/Poisson ratio", std::to_string(nu)},
                      {"Coupling/Zone", zone},
                      {"Boundary conditions/Displacement", std::string("left: ") + zeros[dim]}};
    if (dim == 2)
      settings.push_back({"Elasticity/Plane", plane});
    return settings;
  }


  /** Linear patch, symmetry, momentum and moment of momentum, positive remainders. */
  template <int dim>
  void check_patch(const Settings &settings)
  {
    const CoupledBody<dim>                 body(settings);
    dealii::TrilinosWrappers::SparseMatrix with, without;
    body.op->assemble_intact(with, true);
    body.op->assemble_intact(without, false);
    Vector x = body.values(linear_field<dim>), y(x), z(x);
    with.vmult(y, x);
    without.vmult(z, x);
    const double size = z.linfty_norm();
    y -= z;
    EXPECT_LT(y.linfty_norm() / size, 1e-12);

    x = body.values(bumps<dim>);
    with.vmult(y, x);
    with.Tvmult(z, x);
    z -= y;
    EXPECT_LT(z.linfty_norm() / y.linfty_norm(), 1e-13);

    for (const Vector &motion : body.op->near_null_space())
      EXPECT_LT(std::abs(motion * y) / (motion.linfty_norm() * y.l1_norm()), 1e-13);
    EXPECT_GT(body.op->lowest_remainder(), -1e-12);
  }
} // namespace


TEST(ElasticExchange, linear_patch)
{
  check_patch<1>(box<1>("x - 0.75", 0.));
  check_patch<1>(box<1>("everywhere", 0.));
  for (const std::string zone :
       {"everywhere", "0.16 - (x-0.6)^2 - (y-0.5)^2", "x - 0.75", "sin(50*x)*sin(70*y+1)"})
    {
      for (const double nu : {-0.3, 0., 0.2, 1. / 3., 0.45})
        check_patch<2>(box<2>(zone, nu));
      for (const double nu : {-0.3, 0., 0.25, 0.45})
        check_patch<2>(box<2>(zone, nu, "strain"));
    }
  for (const std::string zone : {"everywhere", "x - 0.35", "sin(50*x)*sin(70*y+1) + z - 0.3"})
    for (const double nu : {-0.2, 0.25, 0.45})
      check_patch<3>(box<3>(zone, nu));
}


TEST(ElasticExchange, linear_patch_on_rectangles)
{
  check_patch<2>(box<2>("x - 0.75", 0.3) + Settings{{"Domain/Upper corner", "1.4, 1.8"}});
  check_patch<3>(box<3>("x - 0.35", 0.3) + Settings{{"Domain/Upper corner", "0.8, 0.84, 0.66"}});
}


TEST(ElasticExchange, layers_stay_exact)
{
  // Two phases in series: the strain jumps at the interface, across which no bond is active.
  const Settings layers =
    box<2>("everywhere", 0.) + Settings{{"Material/Young modulus", "3"},
                                        {"Material/Phases/Regions", "stiff: x > 0.7"},
                                        {"Material/Phases/Young modulus", "stiff: 30"}};
  const CoupledBody<2>                   body(layers);
  dealii::TrilinosWrappers::SparseMatrix with;
  body.op->assemble_intact(with, true);
  Vector y, x = body.values([](const dealii::Point<2> &p) {
    return dealii::Tensor<1, 2>({p[0] < 0.7 ? p[0] : 0.7 + 0.1 * (p[0] - 0.7), 0.});
  });
  body.op->initialize_vector(y);
  with.vmult(y, x);
  for (unsigned int i = 0; i < y.locally_owned_size() / 2; ++i)
    if (body.op->position(i)[0] > 0.01 && body.op->position(i)[0] < 1.39)
      EXPECT_NEAR(y.local_element(2 * i), 0., 1e-12);
}


TEST(ElasticExchange, free_thermal_expansion)
{
  const auto check = [](const Settings &settings, auto dimension) {
    constexpr int    dim = decltype(dimension)::value;
    CoupledBody<dim> body(settings);
    const double     strain =
      0.01 *
      (settings.back().second == "strain" ? 1.3 : 1.); // alpha dT, in plane strain times 1 + nu
    Vector u = body.values([&](const dealii::Point<dim> &p) {
      dealii::Tensor<1, dim> value = strain * p;
      return value;
    });
    Vector r;
    body.op->initialize_vector(r);
    body.op->residual(r, u, 0.);
    EXPECT_LT(r.linfty_norm(), 1e-13);
    EXPECT_NEAR(body.op->energy(u), 0., 1e-14);
  };
  const Settings warm{{"Material/Thermal expansion", "0.001"},
                      {"Elasticity/Temperature change", "10"}};
  check(box<2>("x - 0.7", 0.3) + warm, std::integral_constant<int, 2>());
  check(box<2>("x - 0.7", 0.3) + warm + Settings{{"Elasticity/Plane", "strain"}},
        std::integral_constant<int, 2>());
  check(box<3>("x - 0.3", 0.2) + warm, std::integral_constant<int, 3>());
}


TEST(ElasticExchange, same_on_all_processes)
{
  const Settings settings =
    box<2>("cracks: 1", 0.3) + Settings{{"Cracks/Segments", "0.4, 0.55 ; 1.0, 0.75"},
                                        {"Peridynamics/Surface correction", "crack scaling"}};
  const CoupledBody<2> together(settings), alone(settings, MPI_COMM_SELF);
  Vector               x = together.values(bumps<2>), y(x), x1 = alone.values(bumps<2>), y1(x1);
  together.op->multiply(y, x);
  alone.op->multiply(y1, x1);
  for (unsigned int i = 0; i < y.locally_owned_size() / 2; ++i)
    for (unsigned int k = 0; k < y1.locally_owned_size() / 2; ++k)
      if (together.op->position(i).distance(alone.op->position(k)) < 1e-9)
        for (unsigned int d = 0; d < 2; ++d)
          EXPECT_NEAR(y.local_element(2 * i + d), y1.local_element(2 * k + d), 1e-12);
  EXPECT_EQ(together.op->size().bonds, alone.op->size().bonds);
}
