// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors


#include <perideal/solvers/linear_solver.h>

#include <limits>
#include <random>

#include "elastic_test_tools.h"
#include "scene_test_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;

namespace
{


  /** Fine on the right alone, with hanging nodes between. */
  const Settings graded{{"Domain/Coarsening", "1"}, {"Domain/Fine where", "x - 0.7"}};


  template <int dim>
  void check_operator(const Settings &more, const ModelKind model)
  {
    const Body<dim>        body(box<dim>() + more, model);
    const ElasticOperator &op = body.op();
    const Vector           x = body.values(bumpy_vector<dim>), of_x = body.product(x);
    // Rigid motions make no force, and forces no resultant and no moment.
    const double size = op.diagonal().linfty_norm();
    for (const Vector &motion : op.near_null_space())
      {
        EXPECT_LT(body.product(motion).linfty_norm(), 1e-13 * size);
        EXPECT_LT(std::abs(of_x * motion), 1e-11 * size);
      }
    // Symmetric on the free unknowns; the diagonal is that of K; the bound holds.
    const DenseProperties dense(op);
    EXPECT_LT(dense.asymmetry, 1e-13);
    EXPECT_GT(dense.smallest, -1e-12 * dense.largest);
    const Spectrum spectrum = op.spectrum();
    EXPECT_LE(dense.largest, spectrum.safe * (1. + 1e-12));
    EXPECT_LE(dense.largest, spectrum.sharp * 1.01);
    EXPECT_LT(spectrum.sharp, 1.3 * dense.largest);
    // The energy is half of u K u.
    EXPECT_NEAR(op.energy(x), 0.5 * (x * of_x), 1e-12 * op.energy(x));
    Vector       y = body.vector();
    std::mt19937 random(5);
    for (unsigned int k = 0; k < 3; ++k)
      {
        const auto global = random() % x.size();
        Vector     one(x);
        one = 0.;
        if (one.in_local_range(global))
          one(global) = 1.;
        op.clear_constrained(one);
        const double here = one.l2_norm();
        op.apply(y, one);
        if (here > 0. && one.in_local_range(global))
          {
            EXPECT_NEAR(y(global), op.diagonal()(global), 1e-12 * size);
          }
      }
    EXPECT_GT(x.locally_owned_size(), 0u);
  }


  /**
   * A uniform strain, prescribed on all sides, comes out in the body, with its stress and energy.
   */
  template <int dim>
  void patch_of_elements(const Settings &more)
  {
    const dealii::Tensor<2, dim> g = some_gradient<dim>();
    std::string                  sides;
    for (unsigned int side = 0; side < 2 * dim; ++side)
      {
        sides += (side > 0 ? "; " : "") + box_side_names()[side] + ": ";
        for (unsigned int a = 0; a < dim; ++a)
          {
            sides += a > 0 ? ", " : "";
            for (unsigned int b = 0; b < dim; ++b)
              sides += (b > 0 ? " + (" : "(") + std::to_string(g[a][b]) + ")*" + "xyz"[b];
          }
      }
    const Body<dim>  body(box<dim>() + Settings{{"Boundary conditions/Displacement", sides}} + more,
                         ModelKind::finite_elements);
    ElasticOperator &op = body.op();
    const Vector     u  = body.at_rest(1e-14);
    EXPECT_LT(largest_difference(u, body.values(linear_field<dim>)), 1e-12);
    const auto strain = symmetrize(g);
    const auto sigma =
      stress(body.scene.material.moduli(dealii::Point<dim>()), body.scene.elasticity.plane, strain);
    double volume = 1.;
    for (unsigned int d = 0; d < dim; ++d)
      volume *= body.scene.domain.upper[d];
    EXPECT_NEAR(op.energy(u), 0.5 * volume * (sigma * strain), 1e-12);
    EXPECT_LT(op.forces(u, 0.).imbalance(), 1e-12 * op.forces(u, 0.).throughput());
  }


  /** Dilatation, strain and stress of a uniform strain where families are complete. */
  template <int dim>
  void patch_of_states(const Settings &more, const double stress_error)
  {
    const Body<dim>              body(box<dim>() + more, ModelKind::peridynamics);
    const dealii::Tensor<2, dim> g       = some_gradient<dim>();
    const Vector                 u       = body.values(linear_field<dim>);
    const std::vector<double>    theta   = nodal_dilatations(body.states->bonds(), u);
    const NodalTensors<dim>      tensors = body.states->tensors(u);
    const auto                   strain  = symmetrize(g);
    const auto                   sigma =
      stress(body.scene.material.moduli(dealii::Point<dim>()), body.scene.elasticity.plane, strain);
    const double reach = body.states->bonds().families.weights().reach();
    double       worst = 0., n = 0.;
    for (unsigned int i = 0; i < theta.size(); ++i)
      {
        const dealii::Point<dim> &p        = body.position(i);
        bool                      complete = true;
        for (unsigned int d = 0; d < dim; ++d)
          complete = complete && p[d] > reach * (1. - 1e-9) &&
                     p[d] < body.scene.domain.upper[d] - reach * (1. - 1e-9);
        EXPECT_LT((tensors.strain[i] - strain).norm(), 1e-12); // also of families that are cut off
        if (!complete)
          continue;
        n += 1.;
        EXPECT_NEAR(theta[i], trace(g), 1e-12);
        worst = std::max(worst, (tensors.stress[i] - sigma).norm() / sigma.norm());
      }
    n     = sum_of_all(n);
    worst = max_of_all(worst);
    EXPECT_GT(n, 0.);
    EXPECT_LT(worst, stress_error);
  }


  template <int dim>
  void same_on_all(const Settings &more, const ModelKind model)
  {
    const Body<dim> all(box<dim>() + more, model), alone(box<dim>() + more, model, MPI_COMM_SELF);
    const Vector    u = all.values(bumpy_vector<dim>), v = alone.values(bumpy_vector<dim>),
                 of_v = alone.residual(v);
    EXPECT_LE(difference(all, all.residual(u), alone, of_v), 1e-13 * of_v.linfty_norm());
    EXPECT_NEAR(all.op().energy(u) / alone.op().energy(v), 1., 1e-13);
  }
} // namespace


TEST(ElasticOperator, symmetric_and_without_resultant)
{
  for (const ModelKind model : {ModelKind::finite_elements, ModelKind::peridynamics})
    {
      check_operator<1>({}, model);
      for (const std::string nu : {"-0.4", "0.45"})
        for (const std::string plane : {"stress", "strain"})
          check_operator<2>(
            {{"Domain/Cells", "8, 6"}, {"Material/Poisson ratio", nu}, {"Elasticity/Plane", plane}},
            model);
      check_operator<3>({{"Domain/Cells", "4, 3, 2"}}, model);
    }
  check_operator<2>({{"Domain/Cells", "4, 3"}, {"Finite elements/Degree", "2"}},
                    ModelKind::finite_elements);
  check_operator<2>(graded + Settings{{"Domain/Cells", "8, 6"}}, ModelKind::finite_elements);
  check_operator<2>({{"Domain/Cells", "8, 6"}, {"Elasticity/Model", "bond-based"}},
                    ModelKind::peridynamics);
  check_operator<2>({{"Domain/Cells", "8, 6"},
                     {"Cracks/Segments", "0.2,0.4 ; 0.6,0.3"},
                     {"Elasticity/Contact", "false"}},
                    ModelKind::peridynamics);
  check_operator<2>({{"Domain/Cells", "8, 6"}, {"Domain/Nodes", "cell centers"}},
                    ModelKind::peridynamics);
  for (const std::string law : {"energy", "moments"})
    for (const std::string nodes : {"vertices", "cell centers"})
      {
        const Settings corrected{{"Peridynamics/Surface correction", law}, {"Domain/Nodes", nodes}};
        check_operator<1>(corrected, ModelKind::peridynamics);
        for (const std::string nu : {"-0.4", "0.45"})
          check_operator<2>(corrected +
                              Settings{{"Domain/Cells", "8, 6"}, {"Material/Poisson ratio", nu}},
                            ModelKind::peridynamics);
        check_operator<2>(corrected + Settings{{"Domain/Cells", "8, 6"},
                                               {"Cracks/Segments", "0.2,0.4 ; 0.6,0.3"},
                                               {"Elasticity/Contact", "false"}},
                          ModelKind::peridynamics);
        check_operator<3>(corrected + Settings{{"Domain/Cells", "4, 3, 2"}},
                          ModelKind::peridynamics);
      }
}


TEST(ElasticElements, uniform_strain)
{
  patch_of_elements<1>({});
  for (const std::string plane : {"stress", "strain"})
    for (const std::string nu : {"-0.5", "0", "0.45"})
      patch_of_elements<2>({{"Elasticity/Plane", plane}, {"Material/Poisson ratio", nu}});
  patch_of_elements<2>({{"Finite elements/Degree", "2"}});
  patch_of_elements<3>({});
  patch_of_elements<1>(graded);
  for (const char *const degree : {"1", "2"})
    for (const char *const levels : {"1", "2"})
      patch_of_elements<2>(
        graded + Settings{{"Domain/Coarsening", levels}, {"Finite elements/Degree", degree}});
  patch_of_elements<3>(graded + Settings{{"Domain/Cells", "8, 6, 4"}});
}


TEST(StateOperator, uniform_strain)
{
  patch_of_states<1>({}, 1e-12);
  for (const std::string plane : {"stress", "strain"})
    for (const std::string nu : {"-0.5", "0", "0.3", "0.45"})
      patch_of_states<2>({{"Elasticity/Plane", plane}, {"Material/Poisson ratio", nu}}, 0.2);
  patch_of_states<3>({{"Domain/Cells", "16, 12, 8"}, {"Material/Poisson ratio", "0.3"}}, 0.2);
}


TEST(ElasticOperator, same_on_all_processes)
{
  const Settings warm{{"Material/Thermal expansion", "0.1"},
                      {"Elasticity/Temperature change", "1 + x*x"},
                      {"Boundary conditions/Traction", "right: 1, 2"},
                      {"Initial and source/Body force", "x, y"}};
  for (const ModelKind model : {ModelKind::finite_elements, ModelKind::peridynamics})
    same_on_all<2>(warm, model);
  same_on_all<2>(warm + graded, ModelKind::finite_elements);
  same_on_all<3>(graded, ModelKind::finite_elements);
  same_on_all<2>({{"Cracks/Segments", "0.2,0.4 ; 0.6,0.3"}}, ModelKind::peridynamics);
  same_on_all<3>({}, ModelKind::peridynamics);
  for (const std::string law : {"none", "energy", "moments"})
    for (const std::string nodes : {"vertices", "cell centers"})
      {
        const Settings surface{{"Peridynamics/Surface correction", law},
                               {"Boundary conditions/Traction layer", "0.2"},
                               {"Domain/Nodes", nodes}};
        same_on_all<2>(surface + warm, ModelKind::peridynamics);
        same_on_all<3>(surface + Settings{{"Boundary conditions/Traction", "right: 1, 2, y"}},
                       ModelKind::peridynamics);
      }
}


namespace
{
  /**
   * A body that no side holds back expands freely and without stress: u = alpha dT x, also where
   * families are cut off.
   */
  template <int dim>
  void expand_freely(const ModelKind model, const Settings &more, const double factor = 1.)
  {
    const Body<dim> body(box<dim>() +
                           Settings{{"Boundary conditions/Displacement", ""},
                                    {"Boundary conditions/Symmetry",
                                     dim == 1 ? "left" :
                                     dim == 2 ? "left, bottom" :
                                                "left, bottom, back"},
                                    {"Material/Thermal expansion", "0.02"},
                                    {"Elasticity/Temperature change", "3"}} +
                           more,
                         model);
    const Vector    expected = body.values(
      [&](const dealii::Point<dim> &p) { return 0.06 * factor * dealii::Tensor<1, dim>(p); });
    EXPECT_LT(largest_difference(body.at_rest(1e-13), expected), 1e-12);
  }
} // namespace


TEST(ElasticOperator, free_thermal_expansion)
{
  for (const ModelKind model : {ModelKind::finite_elements, ModelKind::peridynamics})
    {
      expand_freely<1>(model, {});
      expand_freely<2>(model, {});
      expand_freely<2>(model, {{"Elasticity/Plane", "strain"}}, 1.2); // 1 + nu
      expand_freely<3>(model, {});
    }
}


namespace
{
  /**
   * The loads and the energy of a temperature at nodes, and those of the same as a formula; it has
   * been another one before.
   */
  template <int dim>
  void warm_nodes(const ModelKind model, const Settings &more)
  {
    const Settings expands =
      box<dim>() + Settings{{"Material/Thermal expansion", "0.1*(1 + x)"}} + more;
    const std::string formula = dim == 1 ? "2 - 3*x" : dim == 2 ? "2 - 3*x + y" : "2 - 3*x + y - z";
    const Body<dim>   by_formula(expands + Settings{{"Elasticity/Temperature change", formula}},
                               model),
      at_nodes(expands, model);
    ElasticOperator &op = at_nodes.op();
    const Vector     u = at_nodes.values(bumpy_vector<dim>), wanted = by_formula.residual(u);
    Vector           change;
    EXPECT_EQ(op.temperature_change().size(), 0);
    op.initialize_nodal_vector(change);
    change = -7.;
    op.set_temperature_change(change);
    for (unsigned int i = 0; i < change.locally_owned_size(); ++i)
      {
        const auto &p = at_nodes.position(i);
        change.local_element(i) =
          2. - 3. * p[0] + (dim > 1 ? p[1 % dim] : 0.) - (dim > 2 ? p[2 % dim] : 0.);
      }
    op.set_temperature_change(change);
    EXPECT_EQ(op.temperature_change().size(), change.size());
    EXPECT_LT(relative_difference(at_nodes.residual(u), wanted), 1e-13);
    const double energy = by_formula.op().energy(u);
    EXPECT_NEAR(op.energy(u), energy, 1e-13 * energy);
    // Cold again: as if it had never been warm.
    change = 0.;
    op.set_temperature_change(change);
    const Body<dim> cold(expands, model);
    EXPECT_LT(largest_difference(at_nodes.residual(u), cold.residual(u)),
              1e-13 * wanted.linfty_norm());
    EXPECT_NEAR(op.energy(u), cold.op().energy(u), 1e-13 * energy);
  }
} // namespace


TEST(ElasticOperator, temperature_at_nodes_is_that_of_the_formula)
{
  for (const ModelKind model : {ModelKind::finite_elements, ModelKind::peridynamics})
    {
      warm_nodes<1>(model, {});
      warm_nodes<2>(model, {{"Elasticity/Plane", "strain"}});
      warm_nodes<3>(model, {});
    }
  warm_nodes<2>(ModelKind::finite_elements, {{"Finite elements/Degree", "2"}});
  warm_nodes<2>(ModelKind::peridynamics, {{"Domain/Nodes", "cell centers"}});
  warm_nodes<2>(ModelKind::peridynamics,
                {{"Elasticity/Kinematics", "full"}, {"Elasticity/Solver", "conjugate gradients"}});
  warm_nodes<2>(ModelKind::peridynamics, {{"Material/Critical stretch", "0.1"}});
  warm_nodes<2>(ModelKind::coupled, {{"Coupling/Zone", "x - 0.5"}});
}


TEST(ElasticOperator, linear_solver_says_why_it_stopped)
{
  for (const ModelKind model : {ModelKind::finite_elements, ModelKind::peridynamics})
    {
      const Body<2> body(box<2>(), model);
      Vector        x = body.vector(), rhs = body.values(bumpy_vector<2>);
      body.op().clear_constrained(rhs);
      const auto expect_stop = [&](const unsigned int most, const std::string &words) {
        SceneTests::expect_error(
          [&] { LinearSolver(body.op(), 1e-12, most, 50).solve(0., 1., x, rhs); },
          {words});
      };
      expect_stop(3, "Maximum iterations");
      rhs = std::numeric_limits<double>::quiet_NaN();
      x   = 0.;
      expect_stop(100, "loads are not finite");
    }
}
