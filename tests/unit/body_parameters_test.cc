// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// A body that a program describes is that of a scene with the same texts, to the last bit.

#include <deal.II/distributed/tria.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/grid/grid_generator.h>

#include <perideal/base/user_error.h>
#include <perideal/mesh/mesh_builder.h>
#include <perideal/operators/diffusion/cell_term.h>
#include <perideal/operators/diffusion/extended_bond_term.h>
#include <perideal/operators/solid/elastic_elements.h>
#include <perideal/operators/solid/state_operator.h>
#include <perideal/scene/scene.h>

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <string>

using namespace PeriDeal;

namespace
{
  /** The unit square with 16 x 16 cells. */
  struct Square
  {
    Square()
      : mesh(MPI_COMM_WORLD)
      , element(1)
      , dofs(mesh)
    {
      dealii::GridGenerator::subdivided_hyper_cube(mesh, 16, 0., 1., true);
      dofs.distribute_dofs(element);
    }

    dealii::parallel::distributed::Triangulation<2> mesh;
    dealii::FE_Q<2>                                 element;
    dealii::DoFHandler<2>                           dofs;
  };


  void set_square(Scene<2> &scene)
  {
    scene.domain.set("Lower corner", "0, 0");
    scene.domain.set("Upper corner", "1, 1");
    scene.domain.set("Cells", "16, 16");
    scene.peridynamics.set("Boundary treatment", "none");
  }


  /** Largest difference of f - K u at a time, for some u. */
  void expect_same(const std::string &what, const Operator &a, const Operator &b)
  {
    Vector u, y, z;
    for (Vector *vector : {&u, &y, &z})
      a.initialize_vector(*vector);
    for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
      u.local_element(i) = std::sin(1. + 3.7 * i);
    a.distribute(u, 0.7);
    a.residual(y, u, 0.7);
    b.residual(z, u, 0.7);
    EXPECT_GT(y.l2_norm(), 0.);
    z -= y;
    EXPECT_EQ(z.linfty_norm(), 0.) << what;
  }
} // namespace


TEST(BodyParameters, of_heat)
{
  Square   square;
  Scene<2> scene;
  set_square(scene);
  scene.material.set("Conductivity", "1 + x*y");
  scene.material.set("Density", "3");
  scene.initial_and_source.set("Source", "5*t");
  scene.boundary_conditions.set("Dirichlet", "left: 1 + t");
  scene.boundary_conditions.set("Flux", "top: y");
  scene.boundary_conditions.set("Convection", "right: 2, 3");
  scene.parse_and_validate();

  HeatParameters<2> body;
  body.set_box({0., 0.}, {1., 1.}, {{16, 16}});
  body.material.conductivity =
    Expression([](const dealii::Point<3> &p, const double) { return 1. + p[0] * p[1]; }, false);
  body.material.density = 3.;
  body.initial_and_source.source =
    Expression([](const dealii::Point<3> &, const double t) { return 5. * t; }, true);
  body.boundary_conditions.prescribe(
    0,
    Expression([](const dealii::Point<3> &, const double t) { return 1. + t; }, true));
  body.boundary_conditions.let_in(
    "Flux",
    3,
    {Expression([](const dealii::Point<3> &p, const double) { return p[1]; }, false)});
  body.boundary_conditions.let_in("Convection", 1, {2., 3.});

  Nodes<2> of_scene(square.dofs, scene), of_body(square.dofs, body);
  expect_same("bonds", *field_of_bonds(of_scene, scene), *field_of_bonds(of_body, body));
  expect_same("elements",
              *field_of_elements<2>(square.dofs, scene),
              *field_of_elements<2>(square.dofs, body));
}


TEST(BodyParameters, of_a_solid)
{
  Square   square;
  Scene<2> scene;
  scene.general.set("Physics", "elasticity");
  set_square(scene);
  scene.material.set("Young modulus", "3");
  scene.material.set("Poisson ratio", "0.3");
  scene.elasticity.set("Plane", "stress");
  scene.boundary_conditions.set("Symmetry", "bottom");
  scene.boundary_conditions.set("Displacement", "left: 0, free");
  scene.boundary_conditions.set("Traction", "right: 0.6*t, 0.1");
  scene.cracks.set("Segments", "0.3,0.53 ; 0.5,0.53");
  scene.cracks.set("Growth", "2: 0, 0.3,0, 1");
  scene.time.set("End time", "1");
  scene.parse_and_validate();

  SolidParameters<2> body;
  body.set_box({0., 0.}, {1., 1.}, {{16, 16}});
  body.material.set_moduli(Modulus::young, 3., Modulus::poisson, 0.3);
  body.elasticity.plane             = PlaneState::stress;
  body.boundary_conditions.symmetry = {2};
  body.boundary_conditions.displace(0, {0., std::nullopt});
  body.boundary_conditions.pull(
    1,
    {Expression([](const dealii::Point<3> &, const double t) { return 0.6 * t; }, true), 0.1});
  body.cracks.cracks = {{{0.3, 0.53}, {0.5, 0.53}}};
  body.cracks.let_grow(0, 1, dealii::Tensor<1, 2>({0.3, 0.}), 0., 1.);

  Nodes<2>           of_scene(square.dofs, scene), of_body(square.dofs, body);
  StateOperator<2>   a(of_scene, scene), b(of_body, body);
  ElasticElements<2> c(square.dofs, scene), d(square.dofs, body);
  expect_same("bonds", a, b);
  expect_same("elements", c, d);
  Vector u;
  a.initialize_vector(u);
  for (ElasticOperator *op : std::initializer_list<ElasticOperator *>{&a, &b, &c, &d})
    EXPECT_TRUE(op->grow_cracks(u, 0.9));
  expect_same("bonds, grown", a, b);
  expect_same("elements, grown", c, d);
}


TEST(BodyParameters, moduli_that_no_body_has)
{
  SolidParameters<2> body;
  EXPECT_THROW(body.material.set_moduli(Modulus::young, -1., Modulus::poisson, 0.3), UserError);
  EXPECT_THROW(body.material.set_moduli(Modulus::young, 1., Modulus::poisson, 0.7), UserError);
}


TEST(Expression, function_of_a_program)
{
  const Expression f([](const dealii::Point<3> &p, const double t) { return p[0] + 10. * t; },
                     true);
  EXPECT_EQ(f.value(dealii::Point<2>(2., 5.), 3.), 32.);
  EXPECT_FALSE(f.is_constant());
  EXPECT_TRUE(f.depends_on_time());
  const Expression g([](const dealii::Point<3> &p, const double) { return 1. / p[0]; }, false);
  EXPECT_FALSE(g.depends_on_time());
  EXPECT_THROW(g.value(dealii::Point<1>(0.)), UserError);
}
