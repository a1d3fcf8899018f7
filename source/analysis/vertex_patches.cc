// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "vertex_patches.h"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_accessor.h>

#include <perideal/base/instantiate.h>
#include <perideal/operators/coupling/coupling.h>
#include <perideal/operators/parts/element_layout.h>

#include <algorithm>

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
  FluxMesh<dim>::FluxMesh(const DoFHandler<dim> &dofs, const BodyParameters<dim> &body)
    : unit(dofs.get_fe())
    , rim(body.boundary_conditions.holes, dofs.get_triangulation())
    , condensed(unit)
    , elements(dofs)
    , linear(vertex_dofs(dofs.get_triangulation()))
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
  Eigen::VectorXd FluxMesh<dim>::numbers(const Cell        &cell,
                                         const Vector      &u,
                                         const unsigned int component,
                                         const unsigned int n_components) const
  {
    std::vector<types::global_dof_index> indices(dofs().get_fe().n_dofs_per_cell());
    cell->get_dof_indices(indices);
    Eigen::VectorXd numbers(indices.size());
    for (unsigned int i = 0; i < indices.size(); ++i)
      numbers[i] = u(n_components * indices[i] + component);
    return numbers;
  }


  template <int dim>
  VertexPatches<dim>::VertexPatches(FluxMesh<dim> &mesh, const unsigned int n_components)
    : mesh(mesh)
    , sums(mesh.dofs().get_triangulation().n_active_cells())
    , solver(dim - 1, mesh.unit.basis.k, n_components)
    , process(Utilities::MPI::this_mpi_process(mesh.dofs().get_communicator()))
  {}


  template <int dim>
  void VertexPatches<dim>::solve(const Shares &shares)
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
      deal_out(cell, shares(cell));
    exchange_messages();
    for (const Cell &cell : inner)
      {
        deal_out(cell, shares(cell));
        take_found();
      }
    Assert(patches.empty(), ExcInternalError());
    const auto back = Utilities::MPI::some_to_some(mesh.dofs().get_communicator(), returns);
    returns.clear();
    for (const auto &[from, list] : back)
      for (const Return &of_cell : list)
        sums[of_cell.cell] += as_vector(of_cell.outward);
  }


  template <int dim>
  void VertexPatches<dim>::exchange_messages()
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
          cell.means     = as_vector(message.means);
          cell.faces     = message.faces;
          cell.loads     = as_vector(message.loads);
          cell.given     = as_vector(message.given);
          cell.condensed = mesh.condensed.of(corners).first;
          found.push_back(std::move(cell));
        }
    take_found();
  }


  /** Give each vertex what its hat makes of a cell. */
  template <int dim>
  void VertexPatches<dim>::deal_out(const Cell &cell, const VertexShares<dim> &shares)
  {
    sums[cell->active_cell_index()] = Eigen::VectorXd::Zero(shares.loads.rows());
    PatchCell piece;
    piece.cell      = cell->active_cell_index();
    piece.owner     = process;
    piece.factor    = shares.factor;
    piece.condensed = shares.condensed;
    piece.faces     = shares.faces;
    for (const auto &[vertex, hat] : mesh.hats(cell))
      {
        hat.maxCoeff(&piece.corner);
        piece.vertex = vertex;
        piece.means  = shares.means * hat;
        piece.loads  = shares.loads * hat;
        piece.given  = shares.given * hat;
        for (unsigned int f = 0; f < shares.faces.size(); ++f)
          if (shares.faces[f].state == FacePlace::open)
            {
              double on_face = 0.;
              for (unsigned int j = 0; j < GeometryInfo<dim>::vertices_per_cell / 2; ++j)
                on_face += hat[corner_of_face<dim>(f % (2 * dim), j)];
              piece.faces[f].state = on_face > 0. ? FacePlace::open : FacePlace::given;
            }
        if (const unsigned int owner = mesh.owner(vertex); owner == process)
          found.push_back(piece);
        else
          messages[owner].push_back({vertex,
                                     piece.cell,
                                     piece.corner,
                                     piece.factor,
                                     piece.faces,
                                     as_list(piece.means),
                                     as_list(piece.loads),
                                     as_list(piece.given),
                                     {shares.corners.begin(), shares.corners.end()}});
      }
  }


  /** Solve the problems of vertices all cells of which are there. */
  template <int dim>
  void VertexPatches<dim>::take_found()
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
            sums[cells[c].cell] += outward[c];
          else
            returns[cells[c].owner].push_back({cells[c].cell, as_list(outward[c])});
        patches.erase(vertex);
        expected.erase(vertex);
      }
    found.clear();
  }


  PERIDEAL_INSTANTIATE_CLASS(class FluxMesh);
  PERIDEAL_INSTANTIATE_CLASS(class VertexPatches);
} // namespace PeriDeal
