// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "equilibrated_flux.h"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_accessor.h>

#include <perideal/base/instantiate.h>
#include <perideal/operators/parts/element_layout.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    std::unique_ptr<DoFHandler<dim>> vertex_dofs(const Triangulation<dim> &mesh)
    {
      auto dofs = std::make_unique<DoFHandler<dim>>(mesh);
      dofs->distribute_dofs(FE_Q<dim>(1));
      return dofs;
    }


    std::vector<double> as_list(const Eigen::VectorXd &v)
    {
      return std::vector<double>(v.data(), v.data() + v.size());
    }


    Eigen::VectorXd as_vector(const std::vector<double> &v)
    {
      return Eigen::Map<const Eigen::VectorXd>(v.data(), v.size());
    }
  } // namespace


  template <int dim>
  FluxMesh<dim>::FluxMesh(const FieldOperator<dim> &op, const BodyParameters<dim> &body)
    : unit(cells_of(op).dof_handler().get_fe())
    , rim(body.boundary_conditions.holes, cells_of(op).dof_handler().get_triangulation())
    , condensed(unit)
    , op(op)
    , linear(vertex_dofs(cells_of(op).dof_handler().get_triangulation()))
    , hanging(*linear, *element_layout(*linear, static_cast<const Coupling<dim> *>(nullptr)))
  {
    types::global_dof_index begin = 0;
    for (const auto n :
         Utilities::MPI::all_gather(linear->get_communicator(), linear->n_locally_owned_dofs()))
      {
        begins.push_back(begin);
        begin += n;
      }
  }


  template <int dim>
  typename FluxMesh<dim>::HatsInCell FluxMesh<dim>::hats(const Cell &cell) const
  {
    const Cell at = linear_cell(cell);
    HatsInCell result;
    const auto add =
      [&](const types::global_dof_index vertex, const unsigned int v, const double weight) {
        const auto found = std::find_if(result.begin(), result.end(), [&](const auto &hat) {
          return hat.first == vertex;
        });
        if (found == result.end())
          result.emplace_back(vertex, weight * Hat::Unit(v));
        else
          found->second[v] += weight;
      };
    for (unsigned int v = 0; v < GeometryInfo<dim>::vertices_per_cell; ++v)
      {
        const auto        vertex = at->vertex_dof_index(v, 0);
        const auto *const masters =
          hanging.any() ? hanging.constraints().get_constraint_entries(vertex) : nullptr;
        if (masters == nullptr)
          add(vertex, v, 1.);
        else
          for (const auto &[master, weight] : *masters)
            add(master, v, weight);
      }
    return result;
  }


  template <int dim>
  std::vector<FacePlace> FluxMesh<dim>::places(const Cell &cell) const
  {
    std::vector<FacePlace> result;
    for (const unsigned int f : cell->face_indices())
      result.push_back(place_of_face<dim>(linear_cell(cell), f));
    return result;
  }


  template <int dim>
  unsigned int FluxMesh<dim>::owner(const types::global_dof_index vertex) const
  {
    return std::upper_bound(begins.begin(), begins.end(), vertex) - begins.begin() - 1;
  }


  template <int dim>
  Eigen::VectorXd FluxMesh<dim>::numbers(const Cell &cell, const Vector &u) const
  {
    std::vector<types::global_dof_index> indices(dofs().get_fe().n_dofs_per_cell());
    cell->get_dof_indices(indices);
    Eigen::VectorXd numbers(indices.size());
    for (unsigned int i = 0; i < indices.size(); ++i)
      numbers[i] = u(indices[i]);
    return numbers;
  }


  template <int dim>
  bool has_value(const BoundaryConditions<dim> &conditions,
                 const types::boundary_id       side,
                 const MappedPoints<dim>       &at)
  {
    return std::all_of(at.points.begin(), at.points.end(), [&](const Point<dim> &p) {
      return conditions.value_at(side, p) != nullptr;
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
  EquilibratedFlux<dim>::EquilibratedFlux(FluxMesh<dim>          &mesh,
                                          const FluxProblem<dim> &problem,
                                          const Vector           &u)
    : mesh(mesh)
    , problem(problem)
    , u(u)
    , sums(mesh.dofs().get_triangulation().n_active_cells())
    , solver(dim - 1, mesh.unit.basis.k)
    , process(Utilities::MPI::this_mpi_process(mesh.dofs().get_communicator()))
  {
    // Cells with vertices of other processes go first; all others then solve as they come, so that
    // few problems of vertices are kept at a time.
    std::vector<Cell> border, inner;
    for (const Cell &cell : mesh.dofs().active_cell_iterators())
      if (cell->is_locally_owned())
        {
          bool all_own = true;
          for (const auto &[vertex, hat] : mesh.hats(cell))
            if (mesh.owner(vertex) == process)
              ++expected[vertex];
            else
              all_own = false;
          (all_own ? inner : border).push_back(cell);
        }
    for (const Cell &cell : border)
      add(cell);
    exchange_messages();
    for (const Cell &cell : inner)
      {
        add(cell);
        take_found();
      }
    Assert(patches.empty(), ExcInternalError());
    const auto back = Utilities::MPI::some_to_some(mesh.dofs().get_communicator(), returns);
    returns.clear();
    for (const auto &[from, list] : back)
      for (const Return &of_cell : list)
        sums[of_cell.cell].outward += as_vector(of_cell.outward);
    finish();
  }


  template <int dim>
  void EquilibratedFlux<dim>::exchange_messages()
  {
    const auto received = Utilities::MPI::some_to_some(mesh.dofs().get_communicator(), messages);
    messages.clear();
    for (const auto &[from, list] : received)
      for (const Message &message : list)
        {
          ++expected[message.vertex];
          CellCorners<dim> corners;
          std::copy(message.corners.begin(), message.corners.end(), corners.begin());
          PatchCell cell;
          cell.vertex    = message.vertex;
          cell.cell      = message.cell;
          cell.corner    = message.corner;
          cell.owner     = from;
          cell.factor    = message.factor;
          cell.mean      = message.mean;
          cell.faces     = message.faces;
          cell.loads     = as_vector(message.loads);
          cell.given     = as_vector(message.given);
          cell.condensed = mesh.condensed.of(corners).first;
          found.push_back(std::move(cell));
        }
    take_found();
  }


  template <int dim>
  void EquilibratedFlux<dim>::add(const Cell &cell)
  {
    const CellCorners<dim> corners = corners_of<dim>(cell);
    const Eigen::VectorXd  numbers = mesh.numbers(cell, u);
    const CellField<dim>   in_cell(mesh.unit, corners, problem, numbers);
    const HatLoads<dim>    hats(mesh.unit, in_cell);
    const auto [condensed, factor] = mesh.condensed.of(corners);
    Sums &of_cell                  = sums[cell->active_cell_index()];
    of_cell.outward                = Eigen::VectorXd::Zero(mesh.unit.basis.n_of_faces);
    of_cell.loads                  = hats.loads.rowwise().sum() / factor;
    of_cell.divergence             = hats.divergence.rowwise().sum();
    // Numbers that may be kept.
    constexpr std::size_t most = 40000000;
    if (condensed->id < 0 && sums.size() * condensed->by_loads.size() * 3 < most)
      of_cell.condensed = condensed;
    const CellConstants<dim> constants(corners);
    const auto              &weights = mesh.unit.inside.weights;
    const Eigen::VectorXd    rest    = in_cell.at.determinants.cwiseProduct(in_cell.source) -
                                 mesh.unit.inside.products.transpose() * of_cell.divergence;
    of_cell.oscillation.stretch = constants.stretch;
    of_cell.oscillation.cell =
      constants.poincare *
      std::sqrt(
        weights.cwiseProduct(rest.cwiseAbs2()).cwiseQuotient(in_cell.at.determinants).sum() /
        in_cell.conductivity.minCoeff());
    std::vector<FacePlace> places = mesh.places(cell);
    Eigen::MatrixXd        given =
      Eigen::MatrixXd::Zero(mesh.unit.basis.n_of_faces, GeometryInfo<dim>::vertices_per_cell);
    add_faces(cell, corners, numbers, in_cell.conductivity.minCoeff(), places, given);
    const Eigen::MatrixXd loads =
      condensed->by_faces.transpose() * (hats.loads / factor) - condensed->mixed * hats.divergence;
    const Eigen::VectorXd volumes = weights.cwiseProduct(in_cell.at.determinants);
    PatchCell             piece;
    piece.cell      = cell->active_cell_index();
    piece.owner     = process;
    piece.factor    = factor * volumes.sum() / volumes.dot(in_cell.conductivity);
    piece.condensed = condensed;
    piece.faces     = std::move(places);
    deal_out(corners, mesh.hats(cell), hats.divergence.row(0), loads, given, piece);
  }


  /** Give each vertex what its hat makes of a cell, @p piece, which knows all else already. */
  template <int dim>
  void EquilibratedFlux<dim>::deal_out(const CellCorners<dim>                   &corners,
                                       const typename FluxMesh<dim>::HatsInCell &hats,
                                       const Eigen::RowVectorXd                 &means,
                                       const Eigen::MatrixXd                    &loads,
                                       const Eigen::MatrixXd                    &given,
                                       PatchCell                                &piece)
  {
    const std::vector<FacePlace> places = piece.faces;
    for (const auto &[vertex, hat] : hats)
      {
        hat.maxCoeff(&piece.corner);
        piece.vertex = vertex;
        piece.mean   = means * hat;
        piece.loads  = loads * hat;
        piece.given  = given * hat;
        for (unsigned int f = 0; f < places.size(); ++f)
          if (places[f].state == FacePlace::open)
            {
              double on_face = 0.;
              for (unsigned int j = 0; j < GeometryInfo<dim>::vertices_per_cell / 2; ++j)
                on_face += hat[corner_of_face<dim>(f, j)];
              piece.faces[f].state = on_face > 0. ? FacePlace::open : FacePlace::given;
            }
        if (const unsigned int owner = mesh.owner(vertex); owner == process)
          found.push_back(piece);
        else
          messages[owner].push_back({vertex,
                                     piece.cell,
                                     piece.corner,
                                     piece.factor,
                                     piece.mean,
                                     piece.faces,
                                     as_list(piece.loads),
                                     as_list(piece.given),
                                     {corners.begin(), corners.end()}});
      }
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
    const unsigned int       n = mesh.unit.basis.n_of_face;
    const CellConstants<dim> constants(corners);
    Oscillation             &oscillation = sums[cell->active_cell_index()].oscillation;
    for (const unsigned int f : cell->face_indices())
      {
        if (!cell->at_boundary(f))
          continue;
        const UnitPoints<dim>  &unit = mesh.unit.on_faces[f];
        const MappedPoints<dim> at(unit, corners);
        const auto              side = cell->face(f)->boundary_id();
        if (has_value(*problem.conditions, side, at))
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
        given.middleRows(f * n, n) =
          -unit.products * unit.weights.cwiseProduct(density).asDiagonal() * unit.hats.transpose();
        const Eigen::VectorXd rest =
          density -
          unit.products.transpose() * (unit.products * unit.weights.cwiseProduct(density));
        const double square = unit.weights.cwiseProduct(rest.cwiseAbs2()).cwiseQuotient(area).sum();
        const double by_trace = constants.trace(corners, f) * std::sqrt(square / conductivity);
        if (square < least_h * by_trace * by_trace)
          oscillation.sides += square / least_h;
        else
          oscillation.cell += by_trace;
      }
  }


  /** Solve the problems of vertices all cells of which are there. */
  template <int dim>
  void EquilibratedFlux<dim>::take_found()
  {
    for (PatchCell &piece : found)
      {
        const Vertex            vertex = piece.vertex;
        std::vector<PatchCell> &cells  = patches[vertex];
        cells.push_back(std::move(piece));
        if (cells.size() < expected.at(vertex))
          continue;
        const std::vector<Eigen::VectorXd> outward = solver.solve(cells);
        for (unsigned int c = 0; c < cells.size(); ++c)
          if (cells[c].owner == process)
            sums[cells[c].cell].outward += outward[c];
          else
            returns[cells[c].owner].push_back({cells[c].cell, as_list(outward[c])});
        patches.erase(vertex);
        expected.erase(vertex);
      }
    found.clear();
  }


  template <int dim>
  void EquilibratedFlux<dim>::finish()
  {
    for (const Cell &cell : mesh.dofs().active_cell_iterators())
      if (cell->is_locally_owned())
        {
          Sums  &of_cell = sums[cell->active_cell_index()];
          double out     = -of_cell.divergence[0];
          for (unsigned int f = 0; f < 2 * dim; ++f)
            out += of_cell.outward[f * mesh.unit.basis.n_of_face];
          left += std::abs(out);
          const auto condensed = of_cell.condensed ? of_cell.condensed :
                                                     mesh.condensed.of(corners_of<dim>(cell)).first;
          of_cell.loads = condensed->numbers(of_cell.outward, of_cell.loads, of_cell.divergence);
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


#define INSTANTIATE(dim)                                              \
  template class FluxMesh<dim>;                                       \
  template class EquilibratedFlux<dim>;                               \
  template bool   has_value<dim>(const BoundaryConditions<dim> &,     \
                               const types::boundary_id,            \
                               const MappedPoints<dim> &);          \
  template double inflow<dim>(const FluxProblem<dim> &,               \
                              const types::boundary_id,               \
                              const Point<dim> &,                     \
                              const double);                          \
  template double transfer_coefficient<dim>(const FluxProblem<dim> &, \
                                            const types::boundary_id, \
                                            const Point<dim> &);
  PERIDEAL_FOR_EACH_DIM(INSTANTIATE)
#undef INSTANTIATE
} // namespace PeriDeal
