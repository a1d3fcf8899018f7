// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/bonds/halo.h>

#include <algorithm>
#include <limits>
#include <map>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int n_boxes_per_process = 16;

    template <int dim>
    struct Box
    {
      Point<dim> low, high;
      bool       empty = true;

      void include(const Point<dim> &p)
      {
        for (unsigned int d = 0; d < dim; ++d)
          {
            low[d]  = empty ? p[d] : std::min(low[d], p[d]);
            high[d] = empty ? p[d] : std::max(high[d], p[d]);
          }
        empty = false;
      }

      double distance_square(const Point<dim> &p) const
      {
        double sum = 0.;
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double outside = std::max({low[d] - p[d], p[d] - high[d], 0.});
            sum += outside * outside;
          }
        return empty ? std::numeric_limits<double>::max() : sum;
      }
    };


    template <int dim>
    std::vector<Point<dim>> own_positions(const Nodes<dim> &nodes)
    {
      std::vector<Point<dim>> positions(nodes.n_owned());
      for (unsigned int i = 0; i < nodes.n_owned(); ++i)
        positions[i] = nodes.position(i);
      return positions;
    }


    /** Corners of the cells that this process knows; @p margin the diagonal of the smallest of them, twice. */
    template <int dim>
    std::vector<Point<dim>> cell_corners(const Nodes<dim> &nodes, double &margin)
    {
      std::vector<Point<dim>> corners;
      for (const auto &cell : nodes.dof_handler().active_cell_iterators())
        if (!cell->is_artificial())
          {
            for (const unsigned int v : cell->vertex_indices())
              corners.push_back(cell->vertex(v));
            margin = margin == 0. ? 2. * cell->diameter() : std::min(margin, 2. * cell->diameter());
          }
      return corners;
    }


    /** Boxes around consecutive points, as numbers for gathering. */
    template <int dim>
    std::vector<double> boxes_around(const std::vector<Point<dim>> &points)
    {
      std::vector<double> numbers;
      const std::size_t   n = points.size();
      for (unsigned int b = 0; b < n_boxes_per_process && n > 0; ++b)
        {
          Box<dim> box;
          for (std::size_t i = n * b / n_boxes_per_process; i < n * (b + 1) / n_boxes_per_process;
               ++i)
            box.include(points[i]);
          if (!box.empty)
            for (unsigned int d = 0; d < dim; ++d)
              numbers.insert(numbers.end(), {box.low[d], box.high[d]});
        }
      return numbers;
    }


    template <int dim>
    std::vector<Box<dim>> to_boxes(const std::vector<double> &numbers)
    {
      std::vector<Box<dim>> boxes(numbers.size() / (2 * dim));
      for (std::size_t b = 0; b < boxes.size(); ++b)
        {
          Point<dim> low, high;
          for (unsigned int d = 0; d < dim; ++d)
            {
              low[d]  = numbers[2 * (dim * b + d)];
              high[d] = numbers[2 * (dim * b + d) + 1];
            }
          boxes[b].include(low);
          boxes[b].include(high);
        }
      return boxes;
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
  void add_halo(Nodes<dim> &nodes, const double reach, const HaloAround around)
  {
    const MPI_Comm               communicator = nodes.communicator();
    const unsigned int           me           = Utilities::MPI::this_mpi_process(communicator);
    std::vector<NodeRecord<dim>> ghosts;
    if (Utilities::MPI::n_mpi_processes(communicator) > 1)
      {
        double     margin  = 0.;
        const auto boxes   = Utilities::MPI::all_gather(communicator,
                                                      boxes_around(around == HaloAround::nodes ?
                                                                     own_positions(nodes) :
                                                                     cell_corners(nodes, margin)));
        margin             = Utilities::MPI::max(margin, communicator);
        const double limit = std::pow((reach + margin) * (1. + 1e-6), 2);
        std::map<unsigned int, std::vector<double>> to_send;
        for (unsigned int rank = 0; rank < boxes.size(); ++rank)
          {
            const std::vector<Box<dim>> theirs = to_boxes<dim>(boxes[rank]);
            if (rank == me)
              continue;
            for (unsigned int i = 0; i < nodes.n_owned(); ++i)
              if (std::any_of(theirs.begin(), theirs.end(), [&](const Box<dim> &box) {
                    return box.distance_square(nodes.position(i)) <= limit;
                  }))
                append(nodes.record(i), to_send[rank]);
          }
        constexpr unsigned int record_size = 2 + 2 * dim;
        for (const auto &[rank, numbers] : Utilities::MPI::some_to_some(communicator, to_send))
          for (std::size_t k = 0; k < numbers.size(); k += record_size)
            ghosts.push_back(extract<dim>(numbers.data() + k));
      }
    nodes.set_ghosts(std::move(ghosts));
  }


  template void add_halo(Nodes<1> &, const double, const HaloAround);
  template void add_halo(Nodes<2> &, const double, const HaloAround);
  template void add_halo(Nodes<3> &, const double, const HaloAround);
} // namespace PeriDeal
