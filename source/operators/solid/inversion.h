// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/mpi.h>

#include <perideal/base/place_text.h>
#include <perideal/mesh/cell_corners.h>
#include <perideal/operators/solid/elastic_operator.h>

#include <algorithm>
#include <array>
#include <vector>

namespace PeriDeal
{
  /** cell_corners() of the nodes known here, by local number. */
  template <int dim>
  std::vector<CellCorner<dim>> cell_corners_of(const dealii::DoFHandler<dim>             &dofs,
                                               const dealii::Utilities::MPI::Partitioner &nodes)
  {
    return cell_corners<dim>(dofs,
                             nodes.locally_owned_size(),
                             [&](const dealii::types::global_dof_index i) {
                               return nodes.in_local_range(i) || nodes.is_ghost_entry(i) ?
                                        nodes.global_to_local(i) :
                                        dealii::numbers::invalid_unsigned_int;
                             });
  }


  /**
   * Nodes some corner of which has no volume left in the deformed body, and the place of the worst
   * of them. Collective.
   *
   * @param u with up-to-date ghosts; @param counts whether a corner is part of a body that is still
   *          whole, asked for those without volume only
   */
  template <int dim, typename Position, typename Counts>
  Inversion find_inverted(const std::vector<CellCorner<dim>> &corners,
                          const Vector                       &u,
                          const Position                     &position,
                          const Counts                       &counts,
                          const MPI_Comm                      communicator)
  {
    // The smallest ratio; of several that are equal the place with the smallest coordinates.
    std::array<double, dim + 1> worst{};
    std::vector<unsigned int>   nodes;
    for (const CellCorner<dim> &corner : corners)
      {
        const double ratio = volume_ratio(corner, position, u.begin());
        if (!(ratio <= 0.) || !counts(corner))
          continue;
        nodes.push_back(corner.node);
        std::array<double, dim + 1> found;
        found[0] = ratio;
        for (unsigned int d = 0; d < dim; ++d)
          found[d + 1] = position(corner.node)[d];
        if (nodes.size() == 1 || found < worst)
          worst = found;
      }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    Inversion result;
    result.n_nodes =
      dealii::Utilities::MPI::sum(static_cast<unsigned long long>(nodes.size()), communicator);
    if (result.n_nodes == 0)
      return result;
    if (nodes.empty())
      worst[0] = 1.;
    const auto all = dealii::Utilities::MPI::all_gather(communicator, worst);
    worst          = *std::min_element(all.begin(), all.end());
    dealii::Point<dim> place;
    for (unsigned int d = 0; d < dim; ++d)
      place[d] = worst[d + 1];
    result.place = place_text(place);
    return result;
  }
} // namespace PeriDeal
