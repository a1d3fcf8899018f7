// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// The matrix of the state-based operator against the operator itself.

#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <perideal/operators/solid/solid_matrices.h>

#include "elastic_test_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;

namespace
{
  /** assemble_matrix() and multiply() agree, and the matrix is symmetric: v . K u = u . K v. */
  template <int dim>
  void expect_same(const Settings &more, const bool deformed = false)
  {
    const Body<dim>     body(box<dim>() + more, ModelKind::peridynamics);
    StateOperator<dim> &op = *body.states;
    const Vector        u  = body.values(bumpy_vector<dim>);
    const Vector        v  = body.values(
      [](const dealii::Point<dim> &p) { return bumpy_vector<dim>(dealii::Point<dim>(2. * p)); });
    if (deformed)
      op.linearize(
        body.values([](const dealii::Point<dim> &p) { return 0.05 * bumpy_vector<dim>(p); }));
    dealii::TrilinosWrappers::SparseMatrix matrix;
    assemble_matrix(op.bonds(), op.breaking().broken_state(), *u.get_partitioner(), matrix);
    Vector wanted, found;
    op.initialize_vector(wanted);
    op.multiply(wanted, u);
    const dealii::IndexSet                owned = matrix.locally_owned_range_indices();
    dealii::TrilinosWrappers::MPI::Vector x(owned, MPI_COMM_WORLD), y(owned, MPI_COMM_WORLD),
      z(owned, MPI_COMM_WORLD);
    const auto copy = [](const Vector &from, dealii::TrilinosWrappers::MPI::Vector &to) {
      for (unsigned int i = 0; i < from.locally_owned_size(); ++i)
        to(from.get_partitioner()->local_to_global(i)) = from.local_element(i);
      to.compress(dealii::VectorOperation::insert);
    };
    copy(u, x);
    matrix.vmult(y, x);
    copy(wanted, z);
    const double size = z.linfty_norm();
    z -= y;
    EXPECT_GT(size, 0.);
    EXPECT_LT(z.linfty_norm(), 1e-12 * size);
    dealii::TrilinosWrappers::MPI::Vector w(owned, MPI_COMM_WORLD);
    copy(v, w);
    matrix.vmult(z, w);
    EXPECT_NEAR(w * y,
                x * z,
                1e-12 * std::max(w.l2_norm() * y.l2_norm(), x.l2_norm() * z.l2_norm()));
  }
} // namespace


TEST(StateMatrix, is_the_operator)
{
  for (const std::string form : {"stored", "lattice"})
    {
      const Settings chosen = {{"Peridynamics/Operator form", form}};
      expect_same<1>(chosen);
      expect_same<2>(chosen);
      expect_same<2>(chosen +
                     Settings{{"Elasticity/Plane", "strain"}, {"Domain/Nodes", "cell centers"}});
      expect_same<2>(chosen + Settings{{"Elasticity/Model", "bond-based"}});
      expect_same<2>(chosen + Settings{{"Cracks/Segments", "0.3,0.412 ; 0.61,0.33"},
                                       {"Material/Phases/Regions", "stiff: x > 0.6"},
                                       {"Material/Phases/Young modulus", "stiff: 30"},
                                       {"Material/Phases/Poisson ratio", "stiff: 0.1"}});
      expect_same<3>(chosen);
      const Settings completed = chosen + Settings{{"Peridynamics/Surface correction", "auto"},
                                                   {"Boundary conditions/Symmetry", "bottom"}};
      expect_same<2>(completed);
      expect_same<2>(completed + Settings{{"Domain/Nodes", "cell centers"}});
      expect_same<2>(completed + Settings{{"Elasticity/Model", "bond-based"}});
      expect_same<3>(completed);
    }
}


TEST(StateMatrix, is_the_tangent_of_large_displacements)
{
  const Settings full = {{"Elasticity/Kinematics", "full"},
                         {"Elasticity/Solver", "conjugate gradients"}};
  expect_same<2>(full, true);
  expect_same<2>(full + Settings{{"Peridynamics/Surface correction", "auto"},
                                 {"Boundary conditions/Symmetry", "bottom"}},
                 true);
  expect_same<3>(full, true);
}
