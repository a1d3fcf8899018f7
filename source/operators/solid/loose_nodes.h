// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/matrix_rows.h>
#include <perideal/base/types.h>
#include <perideal/operators/parts/cut_cells.h>
#include <perideal/operators/parts/hanging_nodes.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /**
   * What is wrong with a node at a place that next to nothing holds.
   *
   * @param share of the most that holds any node
   */
  inline std::string looseness_text(const std::string &place,
                                    const double       share,
                                    const bool         no_cracks,
                                    const bool         coupled)
  {
    if (share > 0. && no_cracks)
      return "What holds the node at " + place + " to others is " + rounded_text(share) +
             " of the most that holds any, and disappears in its round-off: 'Young modulus' "
             "or what else gives the stiffness in section 'Material' differs too much. Beyond a thousand times "
             "hardly anything changes but that: choose values that differ less, or leave out what is so soft, as a hole.";
    return "The node at " + place +
           " is isolated: cracks cut all cells around it, and no bond holds it. Use " +
           (coupled ?
              "fewer cracks, or a wider 'Zone' in section 'Coupling' where only a part of the body has bonds." :
              "'Models = coupled' with a zone around the cracks, or 'Mesh = faces' in section 'Cracks'.");
  }


  /**
   * Nodes of elements of which cracks leave no cell, as where an oblique crack leaves the body, and
   * the nearest node that has one, in a cell of both and on the same side of the cracks: local
   * numbers of their unknowns, interleaved, ascending. Collective.
   *
   * Hanging nodes neither follow nor lead. @param free 1 at unknowns that no condition prescribes
   */
  template <int dim>
  std::vector<std::pair<unsigned int, unsigned int>>
  find_followers(const dealii::DoFHandler<dim> &dofs,
                 const CutCells<dim>           &cut_cells,
                 const HangingNodes<dim>       &hanging,
                 const Vector                  &free,
                 Vector                         n_kept) // 0 at each node
  {
    const unsigned int                           n = dofs.get_fe().n_dofs_per_cell();
    std::vector<dealii::types::global_dof_index> indices(n);
    const auto for_each_cell = [&](const bool all, const auto &visit) {
      for (const auto &cell : dofs.active_cell_iterators())
        if (all ? !cell->is_artificial() : cell->is_locally_owned())
          if ((cut_cells.kept_of_removed(cell) == 0.) == all)
            {
              cell->get_dof_indices(indices);
              visit(cell);
            }
    };
    for_each_cell(false, [&](const auto &) {
      for (const auto index : indices)
        n_kept(index) += 1.;
    });
    n_kept.compress(dealii::VectorOperation::add);
    n_kept.update_ghost_values();
    // Of nodes equally far the first by place: independent of numbers of processes.
    using Master = std::pair<std::array<double, 1 + dim>, unsigned int>;
    std::map<unsigned int, Master> found;
    const auto                    &layout = *n_kept.get_partitioner();
    for_each_cell(true, [&](const auto &cell) {
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int b = 0; b < n; ++b)
          if (layout.in_local_range(indices[a]) && n_kept(indices[a]) == 0. &&
              n_kept(indices[b]) > 0. && !hanging.is_hanging(dim * indices[a]) &&
              !hanging.is_hanging(dim * indices[b]) &&
              cut_cells.kept_fraction(cell, a, b, [](auto, auto) { return 1.; }) > 0.)
            {
              Master master{{}, layout.global_to_local(indices[b])};
              const double r = cell->vertex(a).distance(cell->vertex(b));
              master.first[0] = std::round(1e6 * r / cell->diameter());
              for (unsigned int d = 0; d < dim; ++d)
                master.first[1 + d] = cell->vertex(b)[d];
              const auto at = found.try_emplace(layout.global_to_local(indices[a]), master).first;
              at->second    = std::min(at->second, master);
            }
    });
    std::vector<std::pair<unsigned int, unsigned int>> pairs;
    for (const auto &[node, master] : found)
      for (unsigned int d = 0; d < dim; ++d)
        if (free.local_element(dim * node + d) != 0.)
          pairs.emplace_back(dim * node + d, dim * master.second + d);
    return pairs;
  }


  /** The diagonal of K of unknowns that nothing holds any more, after breaks, is like others. */
  inline void hold_loose(Vector &diagonal)
  {
    const double largest = diagonal.linfty_norm();
    for (double &value : diagonal)
      if (!(value > 1e-13 * largest))
        value = largest;
  }


  /** Mark by 1 what a matrix holds by next to nothing of a diagonal. Collective. */
  inline void mark_loose(const dealii::TrilinosWrappers::SparseMatrix &matrix,
                         const Vector                                 &diagonal,
                         Vector                                       &marked)
  {
    for_each_entry(matrix, [&](const unsigned int row, const auto column, const double value) {
      if (column == marked.get_partitioner()->local_to_global(row) &&
          !(value > 1e-13 * diagonal.local_element(row)))
        marked.local_element(row) = 1.;
    });
    marked.update_ghost_values();
  }
} // namespace PeriDeal
