// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Families of the linear peridynamic solid that go on beyond the sides (`Surface correction =
// auto`).

#include <cmath>

#include "elastic_scene_tools.h"
#include "elastic_test_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;

namespace
{
  using dealii::Point;
  using dealii::Tensor;

  const Settings centers{{"Domain/Nodes", "cell centers"}};
  const Settings full{{"Elasticity/Kinematics", "full"},
                      {"Elasticity/Solver", "conjugate gradients"}};


  /** A box whose families go on. */
  template <int dim>
  Settings completed()
  {
    return box<dim>() + Settings{{"Peridynamics/Surface correction", "auto"}};
  }


  /**
   * The forces of a uniform strain: none inside. Those of a side carry the stress, sigma n times
   * its area, and all of them balance.
   */
  template <int dim>
  void check_uniform_strain(const Settings &more)
  {
    const Body<dim>           body(completed<dim>() + more, ModelKind::peridynamics);
    const StateOperator<dim> &op = *body.states;
    const Vector              u = body.values(linear_field<dim>), y = body.product(u);
    const double farthest = op.bonds().families.weights().reach() + 1e-9, largest = y.linfty_norm();
    const bool   at_centers = body.scene.domain.nodes == NodePlacement::cell_centers;
    const auto   tensors    = op.tensors(u);
    Tensor<1, dim> right; // the force on the right side
    for (unsigned int i = 0; i < tensors.stress.size(); ++i)
      {
        const Point<dim> &p     = body.position(i);
        bool              inner = true;
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double depth = at_centers ? farthest :
                                              1e-9; // extrapolated from the two outermost rows
            inner              = inner && p[d] > depth && p[d] < body.scene.domain.upper[d] - depth;
          }
        for (unsigned int d = 0; d < dim; ++d)
          {
            if (inner)
              {
                EXPECT_LT(std::abs(y.local_element(dim * i + d)), 1e-12 * largest);
              }
            if (p[0] > body.scene.domain.upper[0] - farthest)
              right[d] += y.local_element(dim * i + d);
          }
        EXPECT_LT((tensors.stress[i] - tensors.stress[0]).norm(), 1e-12 * tensors.stress[0].norm());
      }
    right       = sum_of_all(right);
    double area = 1.;
    for (unsigned int d = 1; d < dim; ++d)
      area *= body.scene.domain.upper[d];
    // Near the edges of the side forces of the sides around it are among these, which cancel but
    // for rotations.
    EXPECT_NEAR(right[0] / (tensors.stress[0][0][0] * area), 1., 1e-11);
    for (const Vector &motion : op.near_null_space())
      EXPECT_LT(std::abs(motion * y), 1e-11 * motion.linfty_norm() * y.l1_norm());
  }


  /** Half a body with a plane of symmetry at x = 0, and the whole one. */
  template <int dim>
  struct Halves
  {
    static Settings sized(const char *lower, const char *cells)
    {
      return completed<dim>() +
             Settings{{"Domain/Lower corner", lower},
                      {"Domain/Cells", cells},
                      {"Boundary conditions/Displacement", std::string("right: ") + zeros[dim]}};
    }

    /** Of a crack that crosses the plane the half body has half. */
    static Settings half_of(Settings more)
    {
      for (auto &[path, text] : more)
        if (path == "Cracks/Segments")
          text = "0,0.412 ; 0.21,0.412";
      return more;
    }

    explicit Halves(const Settings &more)
      : half(sized(zeros[dim], dim == 2 ? "16, 12" : "8, 6, 4") +
               Settings{{"Boundary conditions/Symmetry", "left"}} + half_of(more),
             ModelKind::peridynamics,
             MPI_COMM_SELF)
      , whole(sized(dim == 2 ? "-1, 0" : "-1, 0, 0", dim == 2 ? "32, 12" : "16, 6, 4") +
                Settings{{"Boundary conditions/Displacement",
                          std::string("left: ") + zeros[dim] + " ; right: " + zeros[dim]}} +
                more,
              ModelKind::peridynamics,
              MPI_COMM_SELF)
    {}

    /** A displacement that is its own mirror image. */
    static Tensor<1, dim> field(const Point<dim> &p)
    {
      Tensor<1, dim> u;
      u[0] = 0.02 * std::sin(2. * p[0]) * (1. + p[1]);
      for (unsigned int d = 1; d < dim; ++d)
        u[d] = 0.02 * std::cos((2. + d) * p[0]) * p[d] * p[1];
      return u;
    }

    /** Damage of nodes of the half and the whole body at one place, off the plane. */
    void expect_same_damage() const
    {
      const auto a = half.states->breaking().damage(), b = whole.states->breaking().damage();
      EXPECT_GT(half.n_owned(), 100u);
      for_each_pair(
        half,
        whole,
        [&](const unsigned int i, const unsigned int k) { EXPECT_NEAR(a[i], b[k], 1e-12); },
        1e-9);
    }

    const Body<dim> half, whole;
  };


  template <int dim>
  void check_halves(const Settings &more)
  {
    const Halves<dim> bodies(more);
    const Body<dim>  &a = bodies.half, &b = bodies.whole;
    const Vector      u = a.values(Halves<dim>::field), v = b.values(Halves<dim>::field),
                 of_whole = b.unbalanced(v);
    EXPECT_LE(difference(a, a.unbalanced(u), b, of_whole, 1e-9), 1e-12 * of_whole.linfty_norm());
    const auto of_a = a.states->tensors(u).stress, of_b = b.states->tensors(v).stress;
    for_each_pair(
      a,
      b,
      [&](const unsigned int i, const unsigned int k) {
        EXPECT_LT((of_a[i] - of_b[k]).norm(), 1e-11 * (1. + of_b[k].norm()));
      },
      1e-9);
    bodies.expect_same_damage();
    EXPECT_NEAR(2. * a.op().energy(u) / b.op().energy(v), 1., 1e-12);
  }
} // namespace


TEST(FictitiousBonds, uniform_strains)
{
  for (const std::string form : {"auto", "stored"})
    for (const Settings &nodes : {Settings(), centers})
      {
        const Settings more = nodes + Settings{{"Peridynamics/Operator form", form}};
        check_uniform_strain<1>(more);
        check_uniform_strain<2>(more);
        check_uniform_strain<2>(more + Settings{{"Elasticity/Plane", "strain"}});
        check_uniform_strain<2>(more + Settings{{"Elasticity/Model", "bond-based"}});
        check_uniform_strain<3>(more);
      }
}


TEST(FictitiousBonds, narrower_than_a_family)
{
  // Not slender: those bodies are continued in part.
  const Settings narrow{{"Domain/Upper corner", "0.3125, 0.125"}, {"Domain/Cells", "5, 2"}};
  check_uniform_strain<2>(narrow);
  check_uniform_strain<2>(narrow + centers);
  check_uniform_strain<2>({{"Domain/Upper corner", "1, 0.125"},
                           {"Domain/Cells", "16, 2"},
                           {"Peridynamics/Surface correction", "fictitious nodes"}});
}


TEST(FictitiousBonds, planes_of_symmetry)
{
  for (const Settings &nodes : {Settings(), centers})
    for (const Settings &more : {Settings(),
                                 full,
                                 Settings{{"Material/Thermal expansion", "0.001"},
                                          {"Elasticity/Temperature change", "3 + x*x"}},
                                 // Half a body knows the normals of faces on one side only.
                                 Settings{{"Cracks/Segments", "-0.21,0.412 ; 0.21,0.412"},
                                          {"Elasticity/Contact", "false"}},
                                 Settings{{"Material/Phases/Regions", "stiff: abs(x) > 0.6"},
                                          {"Material/Phases/Young modulus", "stiff: 30"},
                                          {"Material/Phases/Poisson ratio", "stiff: 0.1"}}})
      {
        check_halves<2>(nodes + more);
        if (more.size() < 2)
          check_halves<3>(nodes + (more.empty() ? more : Settings()));
      }
}


TEST(FictitiousBonds, bonds_break_as_in_the_whole_body)
{
  for (const Settings &nodes : {Settings(), centers})
    {
      const Halves<2> bodies(
        nodes + Settings{{"Elasticity/Solver", "dynamics"}, {"Material/Critical stretch", "0.03"}});
      const Vector u    = bodies.half.values(Halves<2>::field),
                   v    = bodies.whole.values(Halves<2>::field);
      const auto n_half = bodies.half.op().break_bonds(u, 0.),
                 n      = bodies.whole.op().break_bonds(v, 0.);
      EXPECT_GT(n_half, 100u);
      EXPECT_NEAR(static_cast<double>(n_half), 0.5 * n, 7.); // those that the plane halves
      EXPECT_NEAR(2. * bodies.half.op().released_energy() / bodies.whole.op().released_energy(),
                  1.,
                  1e-12);
      EXPECT_LE(difference(bodies.half,
                           bodies.half.product(u),
                           bodies.whole,
                           bodies.whole.product(v),
                           1e-9),
                1e-12);
      bodies.expect_same_damage();
    }
}


TEST(FictitiousBonds, same_on_all_processes)
{
  for (const Settings &nodes : {Settings(), centers})
    {
      const Settings settings =
        completed<2>() + nodes + Settings{{"Boundary conditions/Symmetry", "bottom"}};
      const Body<2> together(settings, ModelKind::peridynamics),
        alone(settings, ModelKind::peridynamics, MPI_COMM_SELF);
      const Vector u = together.values(bumpy_vector<2>), v = alone.values(bumpy_vector<2>);
      EXPECT_LE(difference(together, together.product(u), alone, alone.product(v)), 1e-12);
      EXPECT_NEAR(together.op().energy(u) / alone.op().energy(v), 1., 1e-13);
      EXPECT_NEAR(together.op().spectrum().safe / alone.op().spectrum().safe, 1., 1e-12);
    }
}


TEST(FictitiousBonds, turned_bodies_have_no_forces)
{
  const Body<2> body(completed<2>() + full, ModelKind::peridynamics);
  const auto    turned = [](const Point<2> &p) {
    const double c = std::cos(1.2), s = std::sin(1.2);
    return Tensor<1, 2>({c * p[0] - s * p[1] - p[0], s * p[0] + c * p[1] - p[1]});
  };
  EXPECT_LT(body.unbalanced(body.values(turned)).linfty_norm(), 1e-12);
}


TEST(FictitiousBonds, no_scene_is_refused)
{
  using SceneTests::elastic_fault;
  using SceneTests::Overrides;
  const std::string            b = "Boundary conditions/", e = "Elasticity/";
  const std::vector<Overrides> scenes = {
    {},
    {"Models=finite elements"},
    {"Models=coupled", "Coupling/Zone=x-0.5"},
    {"Models=coupled", "Coupling/Zone=x-0.5", "Coupling/Scheme=blending"},
    {"Domain/Nodes=cell centers"},
    {"Peridynamics/Nodal volume=full"},
    {"Cracks/Segments=0.2,0.5 ; 0.5,0.5", "Cracks/Mesh=faces"},
    {"Models=peridynamics", e + "Kinematics=full", e + "Solver=conjugate gradients"},
    {"Material/Fracture energy=0.1"},
    {b + "Traction=right: 1, 0", b + "Traction layer=0.1"},
    {e + "Model=bond-based", e + "Micromodulus=constant"},
    {b + "Symmetry=bottom, top"},
    {b + "Symmetry=top", "Cracks/Segments=0.2,0.5 ; 0.5,0.99"},
    {"Peridynamics/Operator form=lattice"}};
  for (Overrides overrides : scenes)
    {
      overrides.push_back("Peridynamics/Surface correction=auto");
      EXPECT_EQ(elastic_fault(overrides), "");
    }
}
