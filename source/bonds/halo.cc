// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/instantiate.h>
#include <perideal/bonds/halo.h>
#include <perideal/bonds/process_boxes.h>

#include <algorithm>
#include <limits>
#include <map>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    std::vector<Point<dim>> own_positions(const Nodes<dim> &nodes)
    {
      std::vector<Point<dim>> positions(nodes.n_owned());
      for (unsigned int i = 0; i < nodes.n_owned(); ++i)
        positions[i] = nodes.position(i);
      return positions;
    }


    /**
     * Corners of the cells that this process knows; @p margin twice the diagonal of the smallest of
     * them on a lattice, of the largest elsewhere.
     */
    template <int dim>
    std::vector<Point<dim>> cell_corners(const Nodes<dim> &nodes, double &margin)
    {
      std::vector<Point<dim>> corners;
      for (const auto &cell : nodes.dof_handler().active_cell_iterators())
        if (!cell->is_artificial())
          {
            for (const unsigned int v : cell->vertex_indices())
              corners.push_back(cell->vertex(v));
            const double size = 2. * cell->diameter();
            margin            = margin == 0.                ? size :
                                nodes.lattice().has_value() ? std::min(margin, size) :
                                                              std::max(margin, size);
          }
      return corners;
    }


    template <int dim>
    void append(const NodeRecord<dim> &record, std::vector<double> &numbers)
    {
      numbers.push_back(static_cast<double>(record.global_index)); // exact up to 2^53
      numbers.push_back(record.volume);
      numbers.insert(numbers.end(), record.position.begin(), record.position.end());
      numbers.insert(numbers.end(), record.crack_point.begin(), record.crack_point.end());
    }


    template <int dim>
    NodeRecord<dim> extract(const double *numbers)
    {
      NodeRecord<dim> record;
      record.global_index = static_cast<types::global_dof_index>(numbers[0]);
      record.volume       = numbers[1];
      std::copy(numbers + 2, numbers + 2 + dim, record.position.begin());
      std::copy(numbers + 2 + dim, numbers + 2 + 2 * dim, record.crack_point.begin());
      return record;
    }
  } // namespace


  template <int dim>
  void add_halo(Nodes<dim> &nodes, const HaloNeed &need)
  {
    const MPI_Comm               communicator = nodes.communicator();
    const unsigned int           me           = Utilities::MPI::this_mpi_process(communicator);
    std::vector<NodeRecord<dim>> ghosts;
    if (Utilities::MPI::n_mpi_processes(communicator) > 1)
      {
        double                  margin = 0.;
        const ProcessBoxes<dim> boxes(
          need.around == HaloAround::nodes ? own_positions(nodes) : cell_corners(nodes, margin),
          communicator);
        std::map<unsigned int, std::vector<double>> to_send;
        margin = Utilities::MPI::max(margin, communicator);
        for (unsigned int rank = 0; rank < boxes.n_processes(); ++rank)
          for (unsigned int i = 0; i < nodes.n_owned() && rank != me; ++i)
            if (boxes.reach(rank, nodes.position(i), need.reach + margin))
              append(nodes.record(i), to_send[rank]);
        constexpr unsigned int record_size = 2 + 2 * dim;
        for (const auto &[rank, numbers] : Utilities::MPI::some_to_some(communicator, to_send))
          for (std::size_t k = 0; k < numbers.size(); k += record_size)
            ghosts.push_back(extract<dim>(numbers.data() + k));
      }
    nodes.set_ghosts(std::move(ghosts));
  }


  template <int dim>
  void prepare_search(Nodes<dim>                         &nodes,
                      const HaloNeed                     &need,
                      const typename Lattice<dim>::Index &margin)
  {
    const auto known = nodes.search();
    if (!known)
      add_halo(nodes, need);
    AssertThrow(!known || known->halo().covers(need),
                ExcMessage("The nodes have a halo already, and it is too small."));
    bool wide = known != nullptr;
    for (unsigned int d = 0; d < dim && wide; ++d)
      wide = known->margin()[d] >= margin[d];
    if (!wide)
      nodes.set_search(
        std::make_shared<NodeSearch<dim>>(nodes, known ? known->halo() : need, margin));
  }


  PERIDEAL_INSTANTIATE_FUNCTION(prepare_search);
  PERIDEAL_INSTANTIATE_FUNCTION(add_halo);
} // namespace PeriDeal
