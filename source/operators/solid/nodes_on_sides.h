// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/parts/hanging_nodes.h>
#include <perideal/operators/solid/displacement_conditions.h>
#include <perideal/scene/parts.h>

#include <set>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /** Owned nodes on sides and their parts, each once, but for those that hang. */
  template <int dim>
  std::vector<NodeOnSide<dim>> nodes_on_sides(const dealii::DoFHandler<dim>             &dofs,
                                              const dealii::Utilities::MPI::Partitioner &nodes,
                                              const HangingNodes<dim>                   &hanging,
                                              const std::vector<dealii::Point<dim>>     &positions,
                                              const std::vector<Part>                   &parts)
  {
    const auto                                                   &fe = dofs.get_fe();
    std::vector<dealii::types::global_dof_index>                  indices(fe.n_dofs_per_cell());
    std::set<std::pair<dealii::types::boundary_id, unsigned int>> seen;
    std::vector<NodeOnSide<dim>>                                  list;
    for (const auto &cell : dofs.active_cell_iterators())
      {
        if (cell->is_artificial() || !cell->at_boundary())
          continue;
        cell->get_dof_indices(indices);
        for (const unsigned int f : cell->face_indices())
          if (cell->face(f)->at_boundary())
            for (unsigned int i = 0; i < indices.size(); ++i)
              if (fe.has_support_on_face(i, f) && nodes.in_local_range(indices[i]) &&
                  !hanging.is_hanging(dim * indices[i]))
                {
                  const dealii::types::boundary_id side = cell->face(f)->boundary_id();
                  const unsigned int               node = nodes.global_to_local(indices[i]);
                  if (seen.insert({side, node}).second)
                    list.push_back({node, side, positions[node]});
                  for (const Part &part : parts)
                    if (part.side == side && part.holds(positions[node]) &&
                        seen.insert({part.id, node}).second)
                      list.push_back({node, part.id, positions[node]});
                }
      }
    return list;
  }
} // namespace PeriDeal
