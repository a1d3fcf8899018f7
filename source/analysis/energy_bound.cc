// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_accessor.h>

#include <perideal/analysis/energy_bound.h>
#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/operators/parts/element_layout.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "equilibrated_flux.h"
#include "value_lifting.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    using Clock = std::chrono::steady_clock;

    double seconds_since(const Clock::time_point start)
    {
      return std::chrono::duration<double>(Clock::now() - start).count();
    }


    /** Call visit(cell) for the owned cells. */
    template <int dim, typename Visit>
    void for_each_owned(const DoFHandler<dim> &dofs, const Visit &visit)
    {
      for (const auto &cell : dofs.active_cell_iterators())
        if (cell->is_locally_owned())
          visit(cell);
    }


    /**
     * Call visit(face, side, points, rim) for the faces of a cell on the boundary where no value is
     * given.
     */
    template <int dim, typename Cell, typename Visit>
    void for_each_open_side(const FluxMesh<dim>    &mesh,
                            const FluxProblem<dim> &problem,
                            const Cell             &cell,
                            const Visit            &visit)
    {
      if (!cell->at_boundary())
        return;
      const CellCorners<dim> corners = corners_of<dim>(cell);
      const GivenValue<dim>  value   = given_value(problem);
      for (const unsigned int f : cell->face_indices())
        if (cell->at_boundary(f))
          {
            const MappedPoints<dim> at(mesh.unit.on_faces[f], corners);
            const auto              side = cell->face(f)->boundary_id();
            if (!has_value(value, side, at))
              visit(f, side, at, mesh.rim(cell->face(f)));
          }
    }


    /** Gradients in the body, times the root of the weights and kappa. */
    template <int dim>
    Eigen::MatrixXd weighted_gradient(const CellField<dim>  &field,
                                      const Eigen::VectorXd &weights,
                                      const Eigen::MatrixXd &gradient)
    {
      Eigen::MatrixXd result(dim, weights.size());
      for (unsigned int q = 0; q < weights.size(); ++q)
        result.col(q) = std::sqrt(weights[q] * field.conductivity[q] * field.at.determinants[q]) *
                        (field.at.maps[q].inverse().transpose() * gradient.col(q));
      return result;
    }


    /** f(v) - a(u, v) of the unknowns of a cell. */
    template <int dim>
    Eigen::VectorXd cell_residual(const FluxMesh<dim>                                  &mesh,
                                  const FluxProblem<dim>                               &problem,
                                  const typename DoFHandler<dim>::active_cell_iterator &cell,
                                  const Vector                                         &u)
    {
      const Eigen::VectorXd  numbers = mesh.numbers(cell, u);
      const CellField<dim>   field(mesh.unit, corners_of<dim>(cell), problem, numbers);
      const UnitPoints<dim> &inside = mesh.unit.inside;
      Eigen::VectorXd        r =
        inside.shapes *
        inside.weights.cwiseProduct(field.at.determinants).cwiseProduct(field.source);
      for (unsigned int q = 0; q < inside.weights.size(); ++q)
        {
          const auto                          back = field.at.maps[q].inverse();
          const Eigen::Matrix<double, dim, 1> flux =
            inside.weights[q] * field.conductivity[q] * field.at.determinants[q] *
            (back * (back.transpose() * field.gradient.col(q)));
          for (unsigned int d = 0; d < dim; ++d)
            r -= flux[d] * inside.shape_gradients[d].col(q);
        }
      for_each_open_side(
        mesh,
        problem,
        cell,
        [&](const unsigned int f, const auto side, const MappedPoints<dim> &at, const double rim) {
          const UnitPoints<dim> &unit   = mesh.unit.on_faces[f];
          const Eigen::VectorXd  values = unit.shapes.transpose() * numbers;
          for (unsigned int q = 0; q < values.size(); ++q)
            r += rim * unit.weights[q] * at.area(q, f) *
                 inflow(problem, side, at.points[q], values[q]) * unit.shapes.col(q);
        });
      return r;
    }


    /** Two fluxes, together with what bounds of both need. */
    struct FluxSquares
    {
      double first = 0., second = 0., product = 0.;

      double of_sum(const double a, const double b) const
      {
        return std::max(0., a * a * first + 2. * a * b * product + b * b * second);
      }
    };
  } // namespace


  template <int dim>
  struct EnergyBounds<dim>::Parts
  {
    Parts(const FieldOperator<dim> &op, const BodyParameters<dim> &body, const SolveSystem &solve)
      : op(op)
      , body(body)
      , solve(solve)
      , layout(
          element_layout(cells_of(op).dof_handler(), static_cast<const Coupling<dim> *>(nullptr)))
      , mesh(cells_of(op).dof_handler(), body)
    {}

    /** A solution that is one for the quadrature of bounds, too, and its flux. */
    struct Balanced
    {
      FluxProblem<dim>                       problem;
      Vector                                 u;
      std::unique_ptr<EquilibratedFlux<dim>> flux;
      double                                 correction = 0.; // norm of what was added
      EnergyBound                            bound;           // of this u
    };

    std::unique_ptr<Balanced> balanced(const FluxProblem<dim> &problem, const Vector &u) const;
    void                      measure(Balanced &solution) const;
    double                    energy(const FluxProblem<dim> &problem, const Vector &u) const;
    Vector                    residual(const FluxProblem<dim> &problem, const Vector &u) const;
    double                    residual_at(const Balanced &solution, const Vector &v) const;
    FluxProblem<dim>          primal_problem(const double t) const;
    FluxProblem<dim>          dual_problem(const std::string &side) const;
    Vector                    dual_solution(const FluxProblem<dim> &dual,
                                            const std::string      &side,
                                            const bool              of_value) const;
    double                    prescribed_energy(const Balanced &solution, const Vector &v) const;
    std::pair<double, double> product(const Balanced &primal, const Balanced &dual) const;
    double                    flow(const Balanced &primal, const std::string &side) const;

    const FieldOperator<dim>                                        &op;
    const BodyParameters<dim>                                       &body;
    const SolveSystem                                                solve;
    const std::shared_ptr<const dealii::Utilities::MPI::Partitioner> layout;
    mutable FluxMesh<dim>                                            mesh;
  };


  template <int dim>
  double EnergyBounds<dim>::Parts::energy(const FluxProblem<dim> &problem, const Vector &u) const
  {
    double square = 0.;
    for_each_owned(cells_of(op).dof_handler(), [&](const auto &cell) {
      const Eigen::VectorXd numbers = mesh.numbers(cell, u);
      const CellField<dim>  field(mesh.unit, corners_of<dim>(cell), problem, numbers);
      square += weighted_gradient(field, mesh.unit.inside.weights, field.gradient).squaredNorm();
      for_each_open_side(
        mesh,
        problem,
        cell,
        [&](const unsigned int f, const auto side, const MappedPoints<dim> &at, const double rim) {
          const UnitPoints<dim> &unit   = mesh.unit.on_faces[f];
          const Eigen::VectorXd  values = unit.shapes.transpose() * numbers;
          for (unsigned int q = 0; q < values.size(); ++q)
            square += rim * unit.weights[q] * at.area(q, f) *
                      transfer_coefficient(problem, side, at.points[q]) * values[q] * values[q];
        });
    });
    return std::sqrt(Utilities::MPI::sum(square, cells_of(op).dof_handler().get_communicator()));
  }


  template <int dim>
  Vector EnergyBounds<dim>::Parts::residual(const FluxProblem<dim> &problem, const Vector &u) const
  {
    Vector                               r(layout);
    std::vector<types::global_dof_index> indices(
      cells_of(op).dof_handler().get_fe().n_dofs_per_cell());
    for_each_owned(cells_of(op).dof_handler(), [&](const auto &cell) {
      const Eigen::VectorXd of_cell = cell_residual(mesh, problem, cell, u);
      cell->get_dof_indices(indices);
      for (unsigned int i = 0; i < indices.size(); ++i)
        r(indices[i]) += of_cell[i];
    });
    r.compress(VectorOperation::add);
    cells_of(op).hanging_nodes().condense(r);
    Vector owned;
    op.initialize_vector(owned);
    owned.copy_locally_owned_data_from(r);
    op.clear_constrained(owned);
    return owned;
  }


  template <int dim>
  double EnergyBounds<dim>::Parts::residual_at(const Balanced &solution, const Vector &v) const
  {
    double sum = 0.;
    for_each_owned(cells_of(op).dof_handler(), [&](const auto &cell) {
      sum += cell_residual(mesh, solution.problem, cell, solution.u).dot(mesh.numbers(cell, v));
    });
    return Utilities::MPI::sum(sum, cells_of(op).dof_handler().get_communicator());
  }


  /** Fill in the bound. */
  template <int dim>
  void EnergyBounds<dim>::Parts::measure(Balanced &solution) const
  {
    const EquilibratedFlux<dim> &flux = *solution.flux;
    const ValueLifting<dim>      lifting(mesh, given_value(solution.problem));
    const MPI_Comm               communicator = cells_of(op).dof_handler().get_communicator();
    EnergyBound                 &bound        = solution.bound;
    bound.cells.assign(cells_of(op).dof_handler().get_triangulation().n_active_cells(), 0.);
    // Of flux and oscillation, flux alone, sides, values, energy of a flux of 1 through all faces.
    std::array<double, 5> squares{}, all{};
    double                least_h = std::numeric_limits<double>::max();
    for_each_owned(cells_of(op).dof_handler(), [&](const auto &cell) {
      const CellField<dim>  field  = flux.field(cell);
      const double          square = flux.difference(cell, field).squaredNorm();
      const auto           &other  = flux.oscillation(cell);
      const Eigen::VectorXd lift   = lifting.numbers(cell, mesh.numbers(cell, solution.u));
      bound.cells[cell->active_cell_index()] = square;
      squares[0] += std::pow(std::sqrt(square) + other.cell, 2);
      squares[1] += square;
      squares[2] += other.sides;
      if (lift.size() > 0)
        squares[3] +=
          weighted_gradient(field, mesh.unit.inside.weights, lifting.gradient(lift)).squaredNorm();
      squares[4] += dim * other.stretch / field.conductivity.minCoeff();
      for_each_open_side(
        mesh,
        solution.problem,
        cell,
        [&](const unsigned int f, const auto side, const MappedPoints<dim> &at, const double rim) {
          Eigen::VectorXd h(at.points.size());
          for (unsigned int q = 0; q < h.size(); ++q)
            h[q] = rim * mesh.unit.on_faces[f].weights[q] * at.area(q, f) *
                   transfer_coefficient(solution.problem, side, at.points[q]);
          if (!(h.sum() > 0.))
            return;
          least_h = std::min(least_h, h.sum());
          if (dim == 3 && lift.size() > 0)
            squares[3] += h.dot(lifting.values_on_face(lift, f).cwiseAbs2());
        });
    });
    for (unsigned int k = 0; k < squares.size(); ++k)
      all[k] = Utilities::MPI::sum(squares[k], communicator);
    least_h = Utilities::MPI::min(least_h, communicator);
    // What is left flows off through faces in some way, nowhere more than all of it. Through a face
    // of several smaller ones it passes in shares, which these even out.
    const bool   hanging = cells_of(op).dof_handler().get_triangulation().has_hanging_nodes();
    const double spread  = hanging ? 4. : 1.;
    bound.flux           = std::sqrt(all[1]);
    bound.oscillation    = std::sqrt(all[0] + all[2]) - bound.flux;
    bound.values         = std::sqrt(all[3]);
    bound.remainder = spread * flux.imbalance() * (std::sqrt(all[4]) + 1. / std::sqrt(least_h));
    bound.bound     = std::hypot(bound.flux + bound.oscillation + bound.remainder, bound.values);
    if (Utilities::MPI::max(lifting.is_cut() ? 1 : 0, communicator) > 0)
      bound.reservation = "Values end within a face.";
    else if (dim == 3 && hanging && bound.values > 1e-10 * bound.flux)
      bound.reservation = "Hanging nodes may lie on edges of sides with values that are no "
                          "polynomials.";
  }


  template <int dim>
  std::unique_ptr<typename EnergyBounds<dim>::Parts::Balanced> EnergyBounds<dim>::Parts::balanced(
    const FluxProblem<dim> &problem,
    const Vector           &u) const
  {
    // A part of the bound that is not worth a solution.
    constexpr double small    = 0.02;
    auto             solution = std::make_unique<Balanced>();
    solution->problem         = problem;
    solution->u               = with_ghosts(u, layout);
    for (unsigned int step = 0;; ++step)
      {
        solution->flux =
          std::make_unique<EquilibratedFlux<dim>>(mesh, solution->problem, solution->u);
        measure(*solution);
        if (step == 2 || !solve || solution->bound.remainder < small * solution->bound.bound)
          break;
        const Vector r = residual(solution->problem, solution->u);
        Vector       x(r);
        x = 0.;
        solve(x, r);
        cells_of(op).hanging_nodes().interpolate(x);
        const Vector added = with_ghosts(x, layout);
        // All values of it are 0.
        solution->correction += energy(solution->problem, added);
        solution->u.zero_out_ghost_values();
        for (unsigned int i = 0; i < x.locally_owned_size(); ++i)
          solution->u.local_element(i) += x.local_element(i);
        solution->u.update_ghost_values();
      }
    return solution;
  }


  template <int dim>
  FluxProblem<dim> EnergyBounds<dim>::Parts::primal_problem(const double t) const
  {
    // The conditions are the body's, which outlives this.
    return {&body.material,
            std::shared_ptr<const BoundaryConditions<dim>>(std::shared_ptr<void>(),
                                                           &body.boundary_conditions),
            body.initial_and_source.source,
            t};
  }


  /** -div(kappa grad z) = 0, and what is given on the sides made that of a flow through one. */
  template <int dim>
  FluxProblem<dim> EnergyBounds<dim>::Parts::dual_problem(const std::string &side) const
  {
    FluxProblem<dim> dual;
    dual.material         = &body.material;
    const auto conditions = std::make_shared<BoundaryConditions<dim>>();
    conditions->parts     = body.boundary_conditions.parts;
    for (SideCondition condition : body.boundary_conditions.dirichlet)
      {
        condition.value = Expression(condition.name == side ? 1. : 0.);
        conditions->dirichlet.push_back(condition);
      }
    for (SurfaceTransfer transfer : body.boundary_conditions.transfers)
      {
        const Expression h = transfer.coefficient;
        transfer.ambient   = Expression(0.);
        transfer.flux      = Expression(0.);
        if (transfer.name == side && transfer.fixes_level())
          transfer.flux =
            Expression([h](const Point<3> &p, const double) { return -h.value(p); }, false);
        conditions->transfers.push_back(transfer);
      }
    dual.conditions = conditions;
    return dual;
  }


  template <int dim>
  Vector EnergyBounds<dim>::Parts::dual_solution(const FluxProblem<dim> &dual,
                                                 const std::string      &side,
                                                 const bool              of_value) const
  {
    Vector z, rhs, inner;
    op.initialize_vector(z);
    if (of_value)
      mark_side(cells_of(op).dof_handler(),
                *z.get_partitioner(),
                body,
                cells_of(op).hanging_nodes(),
                side,
                z);
    cells_of(op).hanging_nodes().interpolate(z);
    rhs   = residual(dual, with_ghosts(z, layout));
    inner = rhs;
    inner = 0.;
    solve(inner, rhs);
    z += inner;
    cells_of(op).hanging_nodes().interpolate(z);
    return z;
  }


  /** a(w, v) with what values have beyond u, continued into the body. */
  template <int dim>
  double EnergyBounds<dim>::Parts::prescribed_energy(const Balanced &solution,
                                                     const Vector   &v) const
  {
    const ValueLifting<dim> lifting(mesh, given_value(solution.problem));
    double                  sum = 0.;
    for_each_owned(cells_of(op).dof_handler(), [&](const auto &cell) {
      const Eigen::VectorXd lift = lifting.numbers(cell, mesh.numbers(cell, solution.u));
      if (lift.size() == 0)
        return;
      const CellField<dim> field(mesh.unit,
                                 corners_of<dim>(cell),
                                 solution.problem,
                                 mesh.numbers(cell, v));
      const auto          &weights = mesh.unit.inside.weights;
      sum += weighted_gradient(field, weights, field.gradient)
               .cwiseProduct(weighted_gradient(field, weights, lifting.gradient(lift)))
               .sum();
    });
    return Utilities::MPI::sum(sum, cells_of(op).dof_handler().get_communicator());
  }


  /** Between what a(e, e*) is, of the errors of both, that of u without what values add. */
  template <int dim>
  std::pair<double, double> EnergyBounds<dim>::Parts::product(const Balanced &primal,
                                                              const Balanced &dual) const
  {
    const auto  &a = primal.bound, &b = dual.bound;
    const double of_a = a.flux + a.oscillation + a.remainder;
    const double of_b = b.flux + b.oscillation + b.remainder;
    if (!(of_a > 0.) || !(of_b > 0.))
      return {0., 0.};
    const double          s = std::sqrt(of_b / of_a);
    std::array<double, 3> sums{}, all{}; // of s e + e*/s, s e - e*/s; of sides
    for_each_owned(cells_of(op).dof_handler(), [&](const auto &cell) {
      const CellField<dim>  field  = primal.flux->field(cell);
      const Eigen::MatrixXd first  = primal.flux->difference(cell, field);
      const Eigen::MatrixXd second = dual.flux->difference(cell, dual.flux->field(cell));
      const FluxSquares     squares{first.squaredNorm(),
                                second.squaredNorm(),
                                first.cwiseProduct(second).sum()};
      const auto  &o = primal.flux->oscillation(cell), &o_dual = dual.flux->oscillation(cell);
      const double more = s * o.cell + o_dual.cell / s;
      sums[0] += std::pow(std::sqrt(squares.of_sum(s, 1. / s)) + more, 2);
      sums[1] += std::pow(std::sqrt(squares.of_sum(s, -1. / s)) + more, 2);
      sums[2] += 2. * (s * s * o.sides + o_dual.sides / (s * s));
    });
    for (unsigned int k = 0; k < sums.size(); ++k)
      all[k] = Utilities::MPI::sum(sums[k], cells_of(op).dof_handler().get_communicator());
    const double rest  = s * a.remainder + b.remainder / s;
    const auto   bound = [&](const double square) {
      return 0.25 * std::pow(std::sqrt(square + all[2]) + rest, 2);
    };
    return {-bound(all[1]), bound(all[0])};
  }


  /** What enters through a side without a value. */
  template <int dim>
  double EnergyBounds<dim>::Parts::flow(const Balanced &primal, const std::string &side) const
  {
    const auto conditions = std::make_shared<BoundaryConditions<dim>>();
    conditions->parts     = body.boundary_conditions.parts;
    for (const SurfaceTransfer &transfer : body.boundary_conditions.transfers)
      if (transfer.name == side)
        conditions->transfers.push_back(transfer);
    FluxProblem<dim> alone = primal.problem;
    alone.conditions       = conditions;
    double sum             = 0.;
    for_each_owned(cells_of(op).dof_handler(), [&](const auto &cell) {
      for_each_open_side(
        mesh,
        primal.problem,
        cell,
        [&](const unsigned int f, const auto id, const MappedPoints<dim> &at, const double rim) {
          const UnitPoints<dim> &unit   = mesh.unit.on_faces[f];
          const Eigen::VectorXd  values = unit.shapes.transpose() * mesh.numbers(cell, primal.u);
          for (unsigned int q = 0; q < values.size(); ++q)
            sum +=
              rim * unit.weights[q] * at.area(q, f) * inflow(alone, id, at.points[q], values[q]);
        });
    });
    return Utilities::MPI::sum(sum, cells_of(op).dof_handler().get_communicator());
  }


  template <int dim>
  std::string EnergyBounds<dim>::why_not(const BodyParameters<dim> &body)
  {
    if (body.deforms)
      return "the body is a solid";
    if (body.material.conductivity.depends_on_temperature())
      return "'Conductivity' depends on the solution";
    if (body.initial_and_source.source.depends_on_temperature() ||
        depend_on_temperature(body.boundary_conditions.transfers))
      return "what enters through sides or in the body depends on the solution";
    for (const Part &part : body.boundary_conditions.parts)
      if (body.boundary_conditions.side_of(part.id) == numbers::invalid_boundary_id)
        return "there are conditions in regions or at points";
    if (!body.cracks.cracks.empty() && !body.cracks.on_faces())
      return "there are cracks that are no faces of the mesh";
    if (!body.cracks.cracks.empty() && body.cracks.contact_conductance > 0.)
      return "'Contact conductance' lets something through cracks";
    return "";
  }


  template <int dim>
  EnergyBounds<dim>::EnergyBounds(const FieldOperator<dim>  &op,
                                  const BodyParameters<dim> &body,
                                  const SolveSystem         &solve)
    : parts(std::make_unique<Parts>(op, body, solve))
  {}


  template <int dim>
  EnergyBounds<dim>::~EnergyBounds() = default;


  template <int dim>
  EnergyBound EnergyBounds<dim>::of(const Vector &u, const double t) const
  {
    const auto  start    = Clock::now();
    const auto  solution = parts->balanced(parts->primal_problem(t), u);
    EnergyBound bound    = solution->bound;
    bound.bound += solution->correction;
    bound.remainder += solution->correction;
    bound.norm    = parts->energy(solution->problem, with_ghosts(u, parts->layout));
    bound.seconds = seconds_since(start);
    return bound;
  }


  template <int dim>
  FlowBound EnergyBounds<dim>::of_flow_through(const std::string &side,
                                               const Vector      &u,
                                               const double       t) const
  {
    const auto  start    = Clock::now();
    const auto &given    = parts->body.boundary_conditions;
    const auto  named    = [&](const auto &condition) { return condition.name == side; };
    const bool  of_value = std::any_of(given.dirichlet.begin(), given.dirichlet.end(), named);
    AssertThrow(of_value || std::any_of(given.transfers.begin(), given.transfers.end(), named),
                UserError("No value and no transfer is given on the side '" + side +
                          "', so that nothing flows through it."));
    const auto             primal       = parts->balanced(parts->primal_problem(t), u);
    const FluxProblem<dim> dual_problem = parts->dual_problem(side);
    const auto             dual =
      parts->balanced(dual_problem, parts->dual_solution(dual_problem, side, of_value));
    const auto [least, most] = parts->product(*primal, *dual);
    const double of_values   = parts->prescribed_energy(*primal, dual->u);
    const double rest        = primal->bound.values * dual->bound.bound;
    const double r           = parts->residual_at(*primal, dual->u);
    FlowBound    bound;
    // The flow is a(u, z) - f(z) with z = 1 on a side with a value, else -int h u and a constant.
    if (of_value)
      {
        bound.lower = -r + of_values - most - rest;
        bound.upper = -r + of_values - least + rest;
      }
    else
      {
        const double flow = parts->flow(*primal, side);
        bound.lower       = flow + r - of_values + least - rest;
        bound.upper       = flow + r - of_values + most + rest;
      }
    bound.value       = parts->op.balance(u, t, true).sides.at(side);
    bound.reservation = primal->bound.reservation;
    if (dim == 3 && given.transfers_fix_level() &&
        primal->bound.values > 1e-10 * primal->bound.flux && bound.reservation.empty())
      bound.reservation =
        "Sides with values that are no polynomials may meet some with convection.";
    bound.seconds = seconds_since(start);
    return bound;
  }


  PERIDEAL_INSTANTIATE_CLASS(class EnergyBounds);
} // namespace PeriDeal
