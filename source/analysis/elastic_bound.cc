// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/analysis/elastic_bound.h>
#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>

#include "equilibrated_stress.h"
#include "value_lifting.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    using Matrix2 = HookeAt<2>::Matrix;

    /** eps : C eps of a gradient. */
    double density(const HookeAt<2> &law, const Matrix2 &gradient)
    {
      HookeAt<2> cold = law;
      cold.strain     = 0.;
      return cold.stress(gradient).cwiseProduct(gradient).sum();
    }
  } // namespace


  template <int dim>
  struct ElasticBounds<dim>::Parts
  {};


  /** In the plane. */
  template <>
  struct ElasticBounds<2>::Parts
  {
    Parts(const ElasticElements<2> &op,
          const DoFHandler<2>      &dofs,
          const BodyParameters<2>  &body,
          const SolveSystem        &solve)
      : op(op)
      , dofs(dofs)
      , body(body)
      , solve(solve)
      , mesh(dofs, body)
    {}

    /** A solution that is one for the quadrature of bounds, too. */
    struct Balanced
    {
      Vector      u;
      double      correction = 0.; // norm of what was added
      EnergyBound bound;           // of this u
    };

    Balanced        balanced(const StressProblem<2> &problem, const Vector &u) const;
    EnergyBound     measure(const StressProblem<2> &problem, const Vector &u) const;
    double          values(const StressProblem<2> &problem, const Vector &u, bool &cut) const;
    double          largest_motion(const StressProblem<2> &problem) const;
    double          energy(const StressProblem<2> &problem, const Vector &u) const;
    Vector          residual(const StressProblem<2> &problem, const Vector &u) const;
    Eigen::MatrixXd cell_residual(const StressProblem<2>                             &problem,
                                  const typename DoFHandler<2>::active_cell_iterator &cell,
                                  const Vector                                       &u) const;

    Vector with_ghosts(const Vector &u) const
    {
      Vector result;
      op.initialize_vector(result);
      result.copy_locally_owned_data_from(u);
      result.update_ghost_values();
      return result;
    }

    Eigen::MatrixXd numbers(const typename DoFHandler<2>::active_cell_iterator &cell,
                            const Vector                                       &u) const
    {
      Eigen::MatrixXd result(dofs.get_fe().n_dofs_per_cell(), 2);
      for (unsigned int d = 0; d < 2; ++d)
        result.col(d) = mesh.numbers(cell, u, d, 2);
      return result;
    }

    /** Call visit(cell) for the owned cells. */
    template <typename Visit>
    void for_each_owned(const Visit &visit) const
    {
      for (const auto &cell : dofs.active_cell_iterators())
        if (cell->is_locally_owned())
          visit(cell);
    }

    /** Call visit(face, points, side) for the sides of a cell on the boundary. */
    template <typename Cell, typename Visit>
    void for_each_side(const Cell &cell, const Visit &visit) const
    {
      if (cell->at_boundary())
        for (const unsigned int f : cell->face_indices())
          if (cell->at_boundary(f))
            visit(f,
                  MappedPoints<2>(mesh.unit.on_faces[f], corners_of<2>(cell)),
                  cell->face(f)->boundary_id());
    }

    double sum(const double value) const
    {
      return Utilities::MPI::sum(value, dofs.get_communicator());
    }

    const ElasticElements<2> &op;
    const DoFHandler<2>      &dofs;
    const BodyParameters<2>  &body;
    const SolveSystem         solve;
    mutable FluxMesh<2>       mesh;
  };


  double ElasticBounds<2>::Parts::energy(const StressProblem<2> &problem, const Vector &u) const
  {
    double square = 0.;
    for_each_owned([&](const auto &cell) {
      const SolidCell<2> in_cell(mesh.unit, corners_of<2>(cell), problem, numbers(cell, u));
      for (unsigned int q = 0; q < in_cell.laws.size(); ++q)
        square += mesh.unit.inside.weights[q] * in_cell.at.determinants[q] *
                  density(in_cell.laws[q], in_cell.gradients[q]);
    });
    return std::sqrt(sum(square));
  }


  /** f(v) - a(u, v) of the unknowns of a cell; columns: components. */
  Eigen::MatrixXd ElasticBounds<2>::Parts::cell_residual(
    const StressProblem<2>                             &problem,
    const typename DoFHandler<2>::active_cell_iterator &cell,
    const Vector                                       &u) const
  {
    const SolidCell<2>    in_cell(mesh.unit, corners_of<2>(cell), problem, numbers(cell, u));
    const UnitPoints<2>  &inside = mesh.unit.inside;
    const Eigen::VectorXd JxW    = inside.weights.cwiseProduct(in_cell.at.determinants);
    Eigen::MatrixXd       r      = inside.shapes * (JxW.asDiagonal() * in_cell.force);
    for (unsigned int q = 0; q < in_cell.laws.size(); ++q)
      {
        const Matrix2 flux = JxW[q] * in_cell.at.maps[q].inverse() * in_cell.stresses[q];
        for (unsigned int d = 0; d < 2; ++d)
          r -= inside.shape_gradients[d].col(q) * flux.row(d);
      }
    for_each_side(cell, [&](const unsigned int f, const MappedPoints<2> &at, const auto side) {
      const UnitPoints<2> &unit = mesh.unit.on_faces[f];
      const double         rim  = mesh.rim(cell->face(f));
      for (unsigned int q = 0; q < at.points.size(); ++q)
        for (unsigned int d = 0; d < 2; ++d)
          if (const double t = problem.traction(d, side, at.points[q]); t != 0.)
            r.col(d) += rim * unit.weights[q] * at.area(q, f) * t * unit.shapes.col(q);
    });
    return r;
  }


  Vector ElasticBounds<2>::Parts::residual(const StressProblem<2> &problem, const Vector &u) const
  {
    Vector r;
    op.initialize_vector(r);
    std::vector<types::global_dof_index> indices(dofs.get_fe().n_dofs_per_cell());
    for_each_owned([&](const auto &cell) {
      const Eigen::MatrixXd of_cell = cell_residual(problem, cell, u);
      cell->get_dof_indices(indices);
      for (unsigned int i = 0; i < indices.size(); ++i)
        for (unsigned int d = 0; d < 2; ++d)
          r(2 * indices[i] + d) += of_cell(i, d);
    });
    r.compress(VectorOperation::add);
    op.hanging_nodes().condense(r);
    op.clear_constrained(r);
    return r;
  }


  /** The energy of what given displacements have that elements cannot have. */
  double ElasticBounds<2>::Parts::values(const StressProblem<2> &problem,
                                         const Vector           &u,
                                         bool                   &cut) const
  {
    const std::array<ValueLifting<2>, 2> liftings{
      {{mesh, problem.displacement(0)}, {mesh, problem.displacement(1)}}};
    double square = 0.;
    for_each_owned([&](const auto &cell) {
      const Eigen::MatrixXd          of_cell = numbers(cell, u);
      const unsigned int             n       = mesh.unit.inside.weights.size();
      std::array<Eigen::MatrixXd, 2> rows;
      bool                           any = false;
      for (unsigned int d = 0; d < 2; ++d)
        {
          const Eigen::VectorXd lift = liftings[d].numbers(cell, of_cell.col(d));
          rows[d] = lift.size() > 0 ? liftings[d].gradient(lift) : Eigen::MatrixXd::Zero(2, n);
          any     = any || lift.size() > 0;
        }
      if (!any)
        return;
      const MappedPoints<2> at(mesh.unit.inside, corners_of<2>(cell));
      for (unsigned int q = 0; q < n; ++q)
        {
          Matrix2 gradient;
          gradient << rows[0].col(q).transpose(), rows[1].col(q).transpose();
          square += mesh.unit.inside.weights[q] * at.determinants[q] *
                    density(problem.law(at.points[q]), gradient * at.maps[q].inverse());
        }
    });
    cut = Utilities::MPI::max(liftings[0].is_cut() || liftings[1].is_cut() ? 1 : 0,
                              dofs.get_communicator()) > 0;
    return std::sqrt(sum(square));
  }


  /**
   * At most so far a rigid motion r of a cell moves any of its places, r nearest to a displacement
   * v of energy norm 1 that is 0 where it is given. On a face |v - r| <= trace sqrt(korn) |eps(v)|,
   * so that the motions of neighbours differ little there, and not much more elsewhere; a path from
   * any cell leads to what is held.
   */
  double ElasticBounds<2>::Parts::largest_motion(const StressProblem<2> &problem) const
  {
    constexpr double      inf = std::numeric_limits<double>::max();
    std::array<double, 4> ends{{inf, inf, inf, inf}};
    for_each_owned([&](const auto &cell) {
      for (const Point<2> &corner : corners_of<2>(cell))
        for (unsigned int d = 0; d < 2; ++d)
          {
            ends[d]     = std::min(ends[d], corner[d]);
            ends[2 + d] = std::min(ends[2 + d], -corner[d]);
          }
    });
    for (double &end : ends)
      end = Utilities::MPI::min(end, dofs.get_communicator());
    const Point<2> middle(0.5 * (ends[0] - ends[2]), 0.5 * (ends[1] - ends[3]));
    const double   diameter = std::hypot(ends[0] + ends[2], ends[1] + ends[3]);
    // Of all cells, and of the places that are held: their lengths, and motions there.
    double          steps = 0., held = 0., lengths = 0.;
    Eigen::Matrix3d motions = Eigen::Matrix3d::Zero();
    for_each_owned([&](const auto &cell) {
      const CellCorners<2>   corners = corners_of<2>(cell);
      const CellConstants<2> constants(corners);
      double                 least = inf, of_cell = 0., trace = 0.;
      for (const Point<2> &corner : corners)
        least = std::min(least, problem.law(corner + 1e-6 * (cell->center() - corner)).least());
      for (unsigned int f = 0; f < 4; ++f)
        {
          const double h =
            corners[corner_of_face<2>(f, 0)].distance(corners[corner_of_face<2>(f, 1)]);
          const double on = constants.trace(corners, f) * std::sqrt(korn_constant(corners) / least);
          trace           = std::max(trace, on);
          of_cell         = std::max(of_cell, on * 2. / std::sqrt(h) * (1. + 2. * diameter / h));
        }
      steps += of_cell * of_cell;
      for_each_side(cell, [&](const unsigned int f, const MappedPoints<2> &at, const auto side) {
        for (unsigned int d = 0; d < 2; ++d)
          if (has_value(problem.displacement(d), side, at))
            for (unsigned int q = 0; q < at.points.size(); ++q)
              {
                const double    w      = mesh.unit.on_faces[f].weights[q] * at.area(q, f);
                const double    x      = (at.points[q][1 - d] - middle[1 - d]) / diameter;
                Eigen::Vector3d motion = Eigen::Vector3d::Unit(d);
                motion[2]              = d == 0 ? -x : x;
                motions += w * motion * motion.transpose();
                lengths += w;
                held += mesh.unit.on_faces[f].weights[q] * trace * trace;
              }
      });
    });
    for (unsigned int i = 0; i < 9; ++i)
      motions.data()[i] = sum(motions.data()[i]);
    const double from_first = 2. * std::sqrt(sum(steps));
    const double of_first   = std::sqrt(sum(lengths)) * from_first + std::sqrt(sum(held));
    const double s = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(motions, Eigen::EigenvaluesOnly)
                       .eigenvalues()[0];
    return s > 0. ? from_first + std::sqrt(2. / s) * of_first : inf;
  }


  EnergyBound ElasticBounds<2>::Parts::measure(const StressProblem<2> &problem,
                                               const Vector           &u) const
  {
    const EquilibratedStress stress(mesh, problem, u);
    EnergyBound              bound;
    bound.cells.assign(dofs.get_triangulation().n_active_cells(), 0.);
    double square = 0., of_stress = 0.;
    for_each_owned([&](const auto &cell) {
      const StressPart part                  = stress.part(cell);
      bound.cells[cell->active_cell_index()] = part.stress * part.stress;
      of_stress += part.stress * part.stress;
      square += part.all * part.all;
    });
    bool cut          = false;
    bound.flux        = std::sqrt(sum(of_stress));
    bound.oscillation = std::sqrt(sum(square)) - bound.flux;
    bound.values      = values(problem, u, cut);
    bound.remainder   = stress.imbalance() * largest_motion(problem);
    bound.bound       = std::hypot(bound.flux + bound.oscillation + bound.remainder, bound.values);
    const auto faults = Utilities::MPI::all_gather(dofs.get_communicator(), stress.fault());
    for (const std::string &fault : faults)
      if (!fault.empty())
        bound.reservation = fault;
    if (cut)
      bound.reservation = "Displacements are given on parts of faces.";
    return bound;
  }


  ElasticBounds<2>::Parts::Balanced ElasticBounds<2>::Parts::balanced(
    const StressProblem<2> &problem,
    const Vector           &u) const
  {
    // A part of the bound that is not worth a solution.
    constexpr double small = 0.02;
    Balanced         solution;
    solution.u = with_ghosts(u);
    for (unsigned int step = 0;; ++step)
      {
        solution.bound = measure(problem, solution.u);
        if (step == 3 || !solve || solution.bound.remainder < small * solution.bound.bound)
          break;
        const Vector r = residual(problem, solution.u);
        Vector       x(r);
        x = 0.;
        solve(x, r);
        op.hanging_nodes().interpolate(x);
        // All values of it are 0.
        solution.correction += energy(problem, with_ghosts(x));
        solution.u.zero_out_ghost_values();
        for (unsigned int i = 0; i < x.locally_owned_size(); ++i)
          solution.u.local_element(i) += x.local_element(i);
        solution.u.update_ghost_values();
      }
    return solution;
  }


  template <int dim>
  std::string ElasticBounds<dim>::why_not(const BodyParameters<dim> &body)
  {
    const BoundaryConditions<dim> &conditions = body.boundary_conditions;
    const auto                     is_rate    = [](const VectorCondition &c) { return c.rate; };
    if (!body.deforms)
      return "the body is no solid";
    if (dim != 2)
      return "the body is not in the plane";
    if (body.finite_elements.degree < 2)
      return "'Degree' is 1: with those elements moments around vertices are in no balance";
    if (body.elasticity.has_full_kinematics())
      return "'Kinematics' is 'full'";
    if (!body.elasticity.is_static())
      return "the body moves";
    if (body.elasticity.computes_temperature)
      return "the temperature is computed";
    if (lists_bonds(body))
      return "the material breaks, or its 'Law' is not linear";
    for (const Part &part : conditions.parts)
      if (conditions.side_of(part.id) == numbers::invalid_boundary_id)
        return "there are conditions in regions or at points";
    if (std::any_of(conditions.displacement.begin(), conditions.displacement.end(), is_rate))
      return "velocities are given";
    if (conditions.displacement_layer > 0. || conditions.traction_layer > 0.)
      return "conditions hold in layers";
    if (!body.domain.islands.pins.empty())
      return "nodes are pinned";
    if (!body.cracks.cracks.empty() && !body.cracks.on_faces())
      return "there are cracks that are no faces of the mesh";
    return "";
  }


  template <>
  ElasticBounds<2>::ElasticBounds(const ElasticElements<2> &op,
                                  const DoFHandler<2>      &dofs,
                                  const BodyParameters<2>  &body,
                                  const SolveSystem        &solve)
    : parts(std::make_unique<Parts>(op, dofs, body, solve))
  {}


  template <>
  ElasticBounds<3>::ElasticBounds(const ElasticElements<3> &,
                                  const DoFHandler<3> &,
                                  const BodyParameters<3> &body,
                                  const SolveSystem &)
  {
    AssertThrow(false, UserError("There are no bounds of the error: " + why_not(body) + "."));
  }


  template <int dim>
  ElasticBounds<dim>::~ElasticBounds() = default;


  template <>
  EnergyBound ElasticBounds<2>::of(const Vector &u, const double t) const
  {
    using Clock                  = std::chrono::steady_clock;
    const auto             start = Clock::now();
    const StressProblem<2> problem(parts->body, parts->dofs, t);
    const auto             solution = parts->balanced(problem, u);
    EnergyBound            bound    = solution.bound;
    bound.bound += solution.correction;
    bound.remainder += solution.correction;
    bound.norm    = parts->energy(problem, parts->with_ghosts(u));
    bound.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    return bound;
  }


  template <>
  EnergyBound ElasticBounds<3>::of(const Vector &, const double) const
  {
    return {};
  }


  PERIDEAL_INSTANTIATE_CLASS_2_3(class ElasticBounds);
} // namespace PeriDeal
