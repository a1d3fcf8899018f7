// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/analysis/goal_error.h>
#include <perideal/analysis/point_evaluator.h>
#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    PointEvaluator<dim> at_point(const DoFHandler<dim>     &dofs,
                                 const BodyParameters<dim> &body,
                                 const Point<dim>          &point)
    {
      return PointEvaluator<dim>(dofs,
                                 nullptr,
                                 body.cracks,
                                 {std::vector<double>(point.begin_raw(), point.end_raw())},
                                 "'Probes' in section 'Output'");
    }
  } // namespace


  /** A dual solution. */
  template <int dim>
  struct GoalErrors<dim>::Dual
  {
    double value      = 0.; // J(u_h)
    double sign       = 1.; // of r(z) in J(u)
    double of_bubbles = 0.; // J of the bubbles of u, where J(v) is not a(v, z)
    Vector z, bubbles;
  };


  template <int dim>
  GoalErrors<dim>::GoalErrors(const QuadraticElements<dim> &elements,
                              const SolveSystem            &solve,
                              const Vector                 &u,
                              const double                  t)
    : elements(elements)
    , solve(solve)
    , u(u)
    , time(t)
  {
    const Vector given = elements.prescribed_bubbles(u, t);
    Vector       field = elements.prolonged(u);
    field += given;
    residual        = elements.residual(field, t);
    linear_residual = elements.linear_residual(u, t);
    elements.linear_operator().initialize_vector(solver_residual);
    elements.linear_operator().residual(solver_residual, u, t);
    bubbles = elements.recovered_bubbles(u);
    bubbles += given;
    field = elements.prolonged(u);
    field += bubbles;
    residual_with_bubbles = elements.residual(field, t);
  }


  template <int dim>
  typename GoalErrors<dim>::Dual GoalErrors<dim>::point_dual(const Point<dim> &point) const
  {
    const CellTerm<dim>      &cells = cells_of(elements.linear_operator());
    const FieldOperator<dim> &op    = elements.linear_operator();
    const PointEvaluator<dim> reads(at_point(cells.dof_handler(), elements.parameters(), point));
    Dual                      dual;
    Vector                    j(solver_residual.get_partitioner());
    dual.value = reads.evaluate(u)[0];
    // The dual is that of the interpolant's value; the interpolation error is read off.
    dual.of_bubbles =
      at_point(elements.dof_handler(), elements.parameters(), point).evaluate(bubbles)[0];
    reads.add_weights(0, j);
    cells.hanging_nodes().condense(j);
    op.clear_constrained(j);
    dual.z.reinit(j);
    solve(dual.z, j);
    return dual;
  }


  template <int dim>
  typename GoalErrors<dim>::Dual GoalErrors<dim>::transfer_dual(
    const SurfaceTransfer &transfer) const
  {
    const CellTerm<dim>      &cells = cells_of(elements.linear_operator());
    const FieldOperator<dim> &op    = elements.linear_operator();
    BoundaryConditions<dim>   conditions;
    conditions.parts = elements.parameters().boundary_conditions.parts;
    conditions.transfers.push_back(transfer);
    Dual                                 dual;
    Vector                               j = elements.linear_vector();
    const Expression                     nothing;
    const HeatLoads<dim>                 through(cells.dof_handler(),
                                 j.get_partitioner(),
                                 conditions,
                                 nothing,
                                 cells.hanging_nodes());
    std::vector<types::global_dof_index> indices(GeometryInfo<dim>::vertices_per_cell);
    FullMatrix<double>                   of_cell(indices.size(), indices.size());
    for (const auto &cell : cells.dof_handler().active_cell_iterators())
      if (cell->is_locally_owned() && cell->at_boundary())
        {
          through.find_transfer(cell, of_cell);
          cell->get_dof_indices(indices);
          for (unsigned int a = 0; a < indices.size(); ++a)
            for (unsigned int b = 0; b < indices.size(); ++b)
              j(indices[a]) -= of_cell(a, b);
        }
    j.compress(VectorOperation::add);
    cells.hanging_nodes().condense(j);
    op.clear_constrained(j);
    Vector rhs(solver_residual.get_partitioner());
    for (unsigned int i = 0; i < rhs.locally_owned_size(); ++i)
      rhs.local_element(i) = j.local_element(i);
    dual.z.reinit(rhs);
    solve(dual.z, rhs);
    dual.value = op.balance(u, time, true).sides.at(transfer.name);
    return dual;
  }


  template <int dim>
  typename GoalErrors<dim>::Dual GoalErrors<dim>::reaction_dual(const std::string &side) const
  {
    const CellTerm<dim> &cells = cells_of(elements.linear_operator());
    // J(u) = a(u, phi) - f(phi) with any phi that is 1 on the side and 0 on all others with values.
    const FieldOperator<dim> &op = elements.linear_operator();
    Dual                      dual;
    dual.value = op.balance(u, time, true).sides.at(side);
    dual.sign  = -1.;
    dual.z.reinit(solver_residual);
    Vector rhs(dual.z), inner(dual.z);
    mark_side(cells.dof_handler(),
              *dual.z.get_partitioner(),
              elements.parameters(),
              cells.hanging_nodes(),
              side,
              dual.z);
    op.multiply(rhs, dual.z);
    rhs *= -1.;
    op.clear_constrained(rhs);
    solve(inner, rhs);
    dual.z += inner;
    cells.hanging_nodes().interpolate(dual.z);
    dual.bubbles = elements.boundary_bubbles(side, dual.z);
    return dual;
  }


  template <int dim>
  GoalError GoalErrors<dim>::of(const Goal<dim> &goal) const
  {
    const CellTerm<dim> &cells = cells_of(elements.linear_operator());
    Assert(elements.linear_operator().symmetric(), ExcMessage("The dual matrix is another one."));
    const BoundaryConditions<dim> &conditions = elements.parameters().boundary_conditions;
    const auto                     find       = [&](const auto &list) {
      const auto is_it = [&](const auto &condition) { return condition.name == goal.side; };
      return std::find_if(list.begin(), list.end(), is_it);
    };
    const auto transfer = find(conditions.transfers);
    AssertThrow(goal.side.empty() || transfer != conditions.transfers.end() ||
                  find(conditions.dirichlet) != conditions.dirichlet.end(),
                UserError("No value and no transfer is given on the side '" + goal.side +
                          "', so that nothing flows through it."));
    Dual dual = goal.side.empty()                      ? point_dual(goal.point) :
                transfer != conditions.transfers.end() ? transfer_dual(*transfer) :
                                                         reaction_dual(goal.side);
    cells.hanging_nodes().interpolate(dual.z);
    Vector weights = elements.recovered_bubbles(dual.z);
    if (dual.bubbles.size() > 0)
      weights += dual.bubbles;
    Vector z = elements.prolonged(dual.z);
    // The dual solution of a value is singular there, so that bubbles of it are not recovered.
    // Those of u are, and z_h weights them.
    const bool at_a_point = goal.side.empty();
    if (!at_a_point)
      z += weights;
    const Vector &of_field = at_a_point ? residual_with_bubbles : residual;
    GoalError     error;
    error.value = dual.value;
    error.estimate =
      dual.sign * (of_field * z - linear_residual * dual.z + solver_residual * dual.z) +
      dual.of_bubbles;
    error.cells = elements.shares_of_cells(residual, weights);
    for (double &share : error.cells)
      share *= dual.sign;
    return error;
  }


  PERIDEAL_INSTANTIATE_CLASS(struct Goal);
  PERIDEAL_INSTANTIATE_CLASS(class GoalErrors);
} // namespace PeriDeal
