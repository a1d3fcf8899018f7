// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// The state-based operator is symmetric, and its diagonal is what it makes of unit vectors.

#include "elastic_test_tools.h"

using namespace PeriDeal;
using namespace PeriDeal::OperatorTests;

namespace
{
  /** v . K u = u . K v, and u's unknown k alone has the diagonal in row k, for every so many k. */
  template <int dim>
  void expect_symmetric(const Settings &more, const bool deformed = false)
  {
    const Body<dim>     body(box<dim>() + more, ModelKind::peridynamics);
    StateOperator<dim> &op = *body.states;
    const Vector        u  = body.values(bumpy_vector<dim>);
    const Vector        v  = body.values(
      [](const dealii::Point<dim> &p) { return bumpy_vector<dim>(dealii::Point<dim>(2. * p)); });
    if (deformed)
      op.linearize(
        body.values([](const dealii::Point<dim> &p) { return 0.05 * bumpy_vector<dim>(p); }));
    const Vector of_u = body.product(u), of_v = body.product(v);
    EXPECT_GT(of_u.linfty_norm(), 0.);
    EXPECT_NEAR(v * of_u,
                u * of_v,
                1e-12 * std::max(v.l2_norm() * of_u.l2_norm(), u.l2_norm() * of_v.l2_norm()));
    if (deformed) // the diagonal stays that of the undeformed body
      return;

    Vector free(op.diagonal()), one = body.vector();
    free = 1.;
    op.clear_constrained(free);
    unsigned int n_seen = 0;
    for (dealii::types::global_dof_index k = 0; k < free.size(); k += 7)
      {
        const bool is_owned = free.in_local_range(k);
        one                 = 0.;
        if (is_owned)
          one(k) = 1.;
        const Vector row = body.product(one);
        if (is_owned && free(k) > 0.)
          {
            EXPECT_NEAR(row(k) / op.diagonal()(k), 1., 1e-12);
            ++n_seen;
          }
      }
    EXPECT_GT(sum_of_all(n_seen), 0u);
  }
} // namespace


TEST(StateMatrix, is_symmetric_and_has_the_diagonal)
{
  const Settings centers{{"Domain/Nodes", "cell centers"}};
  for (const std::string form : {"stored", "lattice"})
    {
      const Settings chosen = {{"Peridynamics/Operator form", form}};
      expect_symmetric<1>(chosen);
      expect_symmetric<2>(chosen);
      expect_symmetric<2>(chosen + centers + Settings{{"Elasticity/Plane", "strain"}});
      expect_symmetric<2>(chosen + Settings{{"Elasticity/Model", "bond-based"}});
      expect_symmetric<2>(chosen + Settings{{"Cracks/Segments", "0.3,0.412 ; 0.61,0.33"},
                                            {"Material/Phases/Regions", "stiff: x > 0.6"},
                                            {"Material/Phases/Young modulus", "stiff: 30"},
                                            {"Material/Phases/Poisson ratio", "stiff: 0.1"}});
      expect_symmetric<3>(chosen);
      const Settings completed =
        chosen + Settings{{"Peridynamics/Surface correction", "auto"},
                          {"Boundary conditions/Displacement", "left: 0, free"},
                          {"Boundary conditions/Symmetry", "bottom"}};
      expect_symmetric<2>(completed);
      expect_symmetric<2>(completed + centers);
      expect_symmetric<2>(completed + Settings{{"Elasticity/Model", "bond-based"}});
      expect_symmetric<3>(completed +
                          Settings{{"Boundary conditions/Displacement", "left: 0, free, 0"}});
    }
}


TEST(StateMatrix, tangents_of_large_displacements_are_symmetric)
{
  const Settings full = {{"Elasticity/Kinematics", "full"},
                         {"Elasticity/Solver", "conjugate gradients"}};
  expect_symmetric<2>(full, true);
  expect_symmetric<2>(full + Settings{{"Peridynamics/Surface correction", "auto"},
                                      {"Boundary conditions/Symmetry", "bottom"}},
                      true);
  expect_symmetric<3>(full, true);
}
