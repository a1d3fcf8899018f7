// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "solid_cost.h"

#include <deal.II/base/mpi.h>

#include <perideal/base/user_error.h>
#include <perideal/solvers/floating_part.h>
#include <perideal/solvers/linear_solver.h>

namespace PeriDeal
{
  using namespace dealii;

  double time_of_linear_equilibrium(const SolverControlParameters &control,
                                    ElasticOperator               &op,
                                    const double                   t,
                                    const bool                     must_be_held)
  {
    const double start = processor_seconds();
    Vector       u, r, change;
    for (Vector *const v : {&u, &r, &change})
      op.initialize_vector(*v);
    op.distribute(u, t);
    op.residual(r, u, t);
    LinearSolver solver(op, control.tolerance, control.max_iterations, control.direct_up_to);
    if (must_be_held && r.l2_norm() > 0.)
      check_no_loose_part(op, solver.surrogate(), r);
    try
      {
        solver.solve(0., 1., change, r);
      }
    catch (const UserError &) // on all processes
      {
        return -1.;
      }
    return processor_seconds() - start;
  }


  template <int dim>
  double time_of_equilibria(const SolidProblem<dim> &problem,
                            const double             n_steps,
                            const RunContext        &context,
                            double                  &memory)
  {
    const Scene<dim> &scene = problem.scene;
    ElasticOperator  &op    = problem.op();
    // Larger ones take longer than one likes to wait for a check; where there is no coarse lattice
    // one waits some more.
    constexpr double few_unknowns = 5e4, many_unknowns = 3e5;
    // Iterations of other solvers over those of the linear one, where these are alike.
    constexpr double of_full_kinematics = 3.;
    if (scene.elasticity.solver == ElasticSolver::dynamic_relaxation ||
        scene.elasticity.solver == ElasticSolver::adaptive_dynamic_relaxation)
      return -1.;
    const double n_unknowns = static_cast<double>(op.size().unknowns);
    double       first      = 0.;
    if (n_unknowns > few_unknowns)
      first = context.estimate(problem.name(), memory).time_of_solution;
    if (first <= 0. && n_unknowns <= many_unknowns)
      first =
        Utilities::MPI::max(time_of_linear_equilibrium(scene.solver,
                                                       op,
                                                       scene.time.steady ? 0. : scene.time.end_time,
                                                       !op.nonlinear()),
                            problem.dofs().get_communicator());
    if (first <= 0.)
      return -1.;
    if (op.nonlinear())
      first *= of_full_kinematics;
    // A step whose loads grow in proportion starts from its solution, and looks at every bond.
    constexpr double applications_of_step = 5.;
    if (scene.time.steady)
      return first;
    const bool alike = !op.nonlinear() && !scene.warms_slowly() && scene.cracks.tips.empty();
    return first + n_steps * (alike ? applications_of_step * time_of_application(op) : first);
  }


#define PERIDEAL_INSTANTIATE(dim)                               \
  template double time_of_equilibria(const SolidProblem<dim> &, \
                                     const double,              \
                                     const RunContext &,        \
                                     double &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
