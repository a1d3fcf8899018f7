// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "equilibrated_flux.h"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_accessor.h>

#include <perideal/base/instantiate.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  GivenValue<dim> given_value(const FluxProblem<dim> &problem)
  {
    if (problem.conditions->dirichlet.empty())
      return {};
    return [&problem](const types::boundary_id side, const Point<dim> &p) -> std::optional<double> {
      const auto *const condition = problem.conditions->value_at(side, p);
      if (condition == nullptr)
        return {};
      return condition->value.value(p, problem.time);
    };
  }


  template <int dim>
  bool has_value(const GivenValue<dim>   &value,
                 const types::boundary_id side,
                 const MappedPoints<dim> &at)
  {
    return value && std::all_of(at.points.begin(), at.points.end(), [&](const Point<dim> &p) {
             return value(side, p).has_value();
           });
  }


  template <int dim>
  double inflow(const FluxProblem<dim>  &problem,
                const types::boundary_id side,
                const Point<dim>        &p,
                const double             u)
  {
    double q = 0.;
    for (const SurfaceTransfer &transfer : problem.conditions->transfers)
      if (problem.conditions->side_of(transfer.id) == side &&
          problem.conditions->holds_at(transfer.id, p))
        q += transfer.entering(p, problem.time, u);
    return q;
  }


  template <int dim>
  double transfer_coefficient(const FluxProblem<dim>  &problem,
                              const types::boundary_id side,
                              const Point<dim>        &p)
  {
    double h = 0.;
    for (const SurfaceTransfer &transfer : problem.conditions->transfers)
      if (transfer.fixes_level() && problem.conditions->side_of(transfer.id) == side &&
          problem.conditions->holds_at(transfer.id, p))
        h += transfer.coefficient.value(p);
    return h;
  }


  template <int dim>
  FaceLoad face_load(const UnitPoints<dim> &unit,
                     const Eigen::VectorXd &entering,
                     const Eigen::VectorXd &area)
  {
    const Eigen::VectorXd weighted = unit.weights.cwiseProduct(entering);
    const Eigen::VectorXd rest = entering - unit.products.transpose() * (unit.products * weighted);
    return {-unit.products * weighted.asDiagonal() * unit.hats.transpose(),
            unit.weights.cwiseProduct(rest.cwiseAbs2()).cwiseQuotient(area).sum()};
  }


  template <int dim>
  EquilibratedFlux<dim>::EquilibratedFlux(FluxMesh<dim>          &mesh,
                                          const FluxProblem<dim> &problem,
                                          const Vector           &u)
    : mesh(mesh)
    , problem(problem)
    , u(u)
    , sums(mesh.dofs().get_triangulation().n_active_cells())
  {
    VertexPatches<dim> patches(mesh, 1);
    patches.solve([this](const Cell &cell) { return shares(cell); });
    finish(patches);
  }


  /** What hats make of a cell; and what it adds to the bound beside the flux. */
  template <int dim>
  VertexShares<dim> EquilibratedFlux<dim>::shares(const Cell &cell)
  {
    VertexShares<dim> result;
    result.corners                = corners_of<dim>(cell);
    const Eigen::VectorXd numbers = mesh.numbers(cell, u);
    const CellField<dim>  in_cell(mesh.unit, result.corners, problem, numbers);
    const HatLoads<dim>   hats(mesh.unit, in_cell);
    const auto [condensed, factor] = mesh.condensed.of(result.corners);
    Sums &of_cell                  = sums[cell->active_cell_index()];
    of_cell.loads                  = hats.loads.rowwise().sum() / factor;
    of_cell.divergence             = hats.divergence.rowwise().sum();
    // Numbers that may be kept.
    constexpr std::size_t most = 40000000;
    if (condensed->id < 0 && sums.size() * condensed->by_loads.size() * 3 < most)
      of_cell.condensed = condensed;
    const CellConstants<dim> constants(result.corners);
    const auto              &weights = mesh.unit.inside.weights;
    const Eigen::VectorXd    rest    = in_cell.at.determinants.cwiseProduct(in_cell.source) -
                                 mesh.unit.inside.products.transpose() * of_cell.divergence;
    of_cell.oscillation.stretch = constants.stretch;
    of_cell.oscillation.cell =
      constants.poincare *
      std::sqrt(
        weights.cwiseProduct(rest.cwiseAbs2()).cwiseQuotient(in_cell.at.determinants).sum() /
        in_cell.conductivity.minCoeff());
    result.faces = mesh.places(cell);
    result.given =
      Eigen::MatrixXd::Zero(mesh.unit.basis.n_of_faces, GeometryInfo<dim>::vertices_per_cell);
    add_faces(cell,
              result.corners,
              numbers,
              in_cell.conductivity.minCoeff(),
              result.faces,
              result.given);
    result.loads =
      condensed->by_faces.transpose() * (hats.loads / factor) - condensed->mixed * hats.divergence;
    result.means                  = hats.divergence.topRows(1);
    const Eigen::VectorXd volumes = weights.cwiseProduct(in_cell.at.determinants);
    result.factor                 = factor * volumes.sum() / volumes.dot(in_cell.conductivity);
    result.condensed              = condensed;
    return result;
  }


  /** The fluxes through boundary faces that are given, and what projection leaves of them. */
  template <int dim>
  void EquilibratedFlux<dim>::add_faces(const Cell             &cell,
                                        const CellCorners<dim> &corners,
                                        const Eigen::VectorXd  &numbers,
                                        const double            conductivity,
                                        std::vector<FacePlace> &places,
                                        Eigen::MatrixXd        &given)
  {
    if (!cell->at_boundary())
      return;
    const unsigned int       n     = mesh.unit.basis.n_of_face;
    const GivenValue<dim>    value = given_value(problem);
    const CellConstants<dim> constants(corners);
    Oscillation             &oscillation = sums[cell->active_cell_index()].oscillation;
    for (const unsigned int f : cell->face_indices())
      {
        if (!cell->at_boundary(f))
          continue;
        const UnitPoints<dim>  &unit = mesh.unit.on_faces[f];
        const MappedPoints<dim> at(unit, corners);
        const auto              side = cell->face(f)->boundary_id();
        if (has_value(value, side, at))
          {
            places[f].state = FacePlace::open;
            continue;
          }
        const Eigen::VectorXd values = unit.shapes.transpose() * numbers;
        const double          rim    = mesh.rim(cell->face(f));
        Eigen::VectorXd       density(values.size()), area(values.size());
        double                least_h = std::numeric_limits<double>::max();
        for (unsigned int q = 0; q < values.size(); ++q)
          {
            area[q]    = at.area(q, f);
            density[q] = rim * area[q] * inflow(problem, side, at.points[q], values[q]);
            least_h    = std::min(least_h, rim * transfer_coefficient(problem, side, at.points[q]));
          }
        const FaceLoad load        = face_load(unit, density, area);
        given.middleRows(f * n, n) = load.hats;
        const double by_trace = constants.trace(corners, f) * std::sqrt(load.rest / conductivity);
        if (load.rest < least_h * by_trace * by_trace)
          oscillation.sides += load.rest / least_h;
        else
          oscillation.cell += by_trace;
      }
  }


  template <int dim>
  void EquilibratedFlux<dim>::finish(const VertexPatches<dim> &patches)
  {
    for (const Cell &cell : mesh.dofs().active_cell_iterators())
      if (cell->is_locally_owned())
        {
          Sums                  &of_cell = sums[cell->active_cell_index()];
          const Eigen::VectorXd &outward = patches.outward(cell);
          double                 out     = -of_cell.divergence[0];
          for (unsigned int f = 0; f < 2 * dim; ++f)
            out += outward[f * mesh.unit.basis.n_of_face];
          left += std::abs(out);
          const auto condensed = of_cell.condensed ? of_cell.condensed :
                                                     mesh.condensed.of(corners_of<dim>(cell)).first;
          of_cell.loads        = condensed->numbers(outward, of_cell.loads, of_cell.divergence);
          of_cell.condensed.reset();
        }
    left = Utilities::MPI::sum(left, mesh.dofs().get_communicator());
  }


  template <int dim>
  CellField<dim> EquilibratedFlux<dim>::field(const Cell &cell) const
  {
    return CellField<dim>(mesh.unit, corners_of<dim>(cell), problem, mesh.numbers(cell, u), false);
  }


  template <int dim>
  Eigen::MatrixXd EquilibratedFlux<dim>::difference(const Cell           &cell,
                                                    const CellField<dim> &field) const
  {
    const Eigen::VectorXd &c    = sums[cell->active_cell_index()].loads;
    Eigen::MatrixXd        flux = Eigen::MatrixXd::Zero(dim, field.values.size());
    for (unsigned int d = 0; d < dim; ++d)
      {
        const auto     &with = mesh.unit.numbers_along[d];
        Eigen::VectorXd numbers(with.size());
        for (unsigned int i = 0; i < with.size(); ++i)
          numbers[i] = c[with[i]];
        flux.row(d) = numbers.transpose() * mesh.unit.along[d];
      }
    for (unsigned int q = 0; q < field.values.size(); ++q)
      {
        const auto  &map   = field.at.maps[q];
        const double J     = field.at.determinants[q];
        const double kappa = field.conductivity[q];
        flux.col(q) =
          std::sqrt(mesh.unit.inside.weights[q] / (kappa * J)) *
          (map * flux.col(q) + kappa * J * map.inverse().transpose() * field.gradient.col(q));
      }
    return flux;
  }


#define INSTANTIATE(dim)                                                       \
  template class EquilibratedFlux<dim>;                                        \
  template bool            has_value<dim>(const GivenValue<dim> &,             \
                               const types::boundary_id,            \
                               const MappedPoints<dim> &);          \
  template GivenValue<dim> given_value<dim>(const FluxProblem<dim> &);         \
  template FaceLoad        face_load<dim>(const UnitPoints<dim> &,             \
                                   const Eigen::VectorXd &,             \
                                   const Eigen::VectorXd &);            \
  template double          inflow<dim>(const FluxProblem<dim> &,               \
                              const types::boundary_id,               \
                              const Point<dim> &,                     \
                              const double);                          \
  template double          transfer_coefficient<dim>(const FluxProblem<dim> &, \
                                            const types::boundary_id, \
                                            const Point<dim> &);
  PERIDEAL_FOR_EACH_DIM(INSTANTIATE)
#undef INSTANTIATE
} // namespace PeriDeal
