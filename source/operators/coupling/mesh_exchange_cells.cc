// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// The cells around this process's own, copies of those of other processes included.

#include <deal.II/base/mpi.h>

#include <perideal/bonds/process_boxes.h>
#include <perideal/operators/coupling/mesh_exchange.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim, typename Law>
  void MeshExchange<dim, Law>::find_cells()
  {
    const DoFHandler<dim> &dofs = own_families.nodes().dof_handler();
    cell_of_index.assign(dofs.get_triangulation().n_active_cells(), numbers::invalid_unsigned_int);
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          PathCell<dim> shape;
          for (unsigned int v = 0; v < n_corners; ++v)
            {
              shape.corners[v] = cell->vertex(v);
              shape.nodes[v]   = cell->vertex_dof_index(v, 0);
            }
          cell_of_index[cell->active_cell_index()] = cells.size();
          cells.push_back(shape);
          states.push_back({stiffness.range(shape.corners, nullptr)});
        }
    taken.resize(cells.size());
  }


  template <int dim, typename Law>
  void MeshExchange<dim, Law>::send_cells()
  {
    const Nodes<dim>  &nodes        = own_families.nodes();
    const MPI_Comm     communicator = nodes.communicator();
    const unsigned int me           = Utilities::MPI::this_mpi_process(communicator);
    if (Utilities::MPI::n_mpi_processes(communicator) == 1)
      return;
    // A bond through a cell of another process may pass any cell within its reach of that one.
    std::vector<Point<dim>> own_corners;
    double                  size = 0.;
    for (const PathCell<dim> &cell : cells)
      {
        own_corners.insert(own_corners.end(), cell.corners.begin(), cell.corners.end());
        for (unsigned int v = 1; v < n_corners; ++v)
          size = std::max(size, cell.corners[v].distance(cell.corners[0]));
      }
    const ProcessBoxes<dim> boxes(own_corners, communicator);
    const double            distance =
      own_families.weights().reach() + Utilities::MPI::max(size, communicator);
    std::map<unsigned int, std::vector<double>> to_send;
    for (unsigned int rank = 0; rank < boxes.n_processes(); ++rank)
      for (unsigned int c = 0; c < cells.size() && rank != me; ++c)
        if (std::any_of(cells[c].corners.begin(), cells[c].corners.end(), [&](const auto &p) {
              return boxes.reach(rank, p, distance);
            }))
          {
            sent[rank].push_back(c);
            auto &numbers = to_send[rank];
            for (const Point<dim> &p : cells[c].corners)
              for (unsigned int d = 0; d < dim; ++d)
                numbers.push_back(p[d]);
            for (const auto node : cells[c].nodes)
              numbers.push_back(static_cast<double>(node)); // exact up to 2^53
          }
    constexpr unsigned int record_size = n_corners * (dim + 1);
    for (const auto &[rank, numbers] : Utilities::MPI::some_to_some(communicator, to_send))
      for (std::size_t k = 0; k < numbers.size(); k += record_size)
        {
          PathCell<dim> shape;
          for (unsigned int v = 0; v < n_corners; ++v)
            {
              for (unsigned int d = 0; d < dim; ++d)
                shape.corners[v][d] = numbers[k + v * dim + d];
              shape.nodes[v] =
                static_cast<types::global_dof_index>(numbers[k + n_corners * dim + v]);
            }
          received[rank].push_back(cells.size());
          cells.push_back(shape);
          states.emplace_back();
        }
    share_states();
  }


  template <int dim, typename Law>
  void MeshExchange<dim, Law>::share_states()
  {
    const MPI_Comm communicator = own_families.nodes().communicator();
    if (Utilities::MPI::n_mpi_processes(communicator) == 1)
      return;
    std::map<unsigned int, std::vector<double>> to_send;
    for (const auto &[rank, list] : sent)
      for (const unsigned int c : list)
        {
          const auto &[of_stiffness, strain] = states[c];
          to_send[rank].insert(to_send[rank].end(),
                               {of_stiffness.lowest, of_stiffness.highest, strain});
        }
    for (const auto &[rank, numbers] : Utilities::MPI::some_to_some(communicator, to_send))
      for (std::size_t k = 0; k < numbers.size() / 3; ++k)
        states[received.at(rank)[k]] = {{numbers[3 * k], numbers[3 * k + 1]}, numbers[3 * k + 2]};
  }


#define PERIDEAL_INSTANTIATE(dim, Law)                     \
  template void MeshExchange<dim, Law<dim>>::find_cells(); \
  template void MeshExchange<dim, Law<dim>>::send_cells(); \
  template void MeshExchange<dim, Law<dim>>::share_states();
  PERIDEAL_INSTANTIATE(1, ConductingBonds)
  PERIDEAL_INSTANTIATE(2, ConductingBonds)
  PERIDEAL_INSTANTIATE(3, ConductingBonds)
  PERIDEAL_INSTANTIATE(1, ElasticBonds)
  PERIDEAL_INSTANTIATE(2, ElasticBonds)
  PERIDEAL_INSTANTIATE(3, ElasticBonds)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
