// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/matrix_rows.h>
#include <perideal/base/types.h>
#include <perideal/scene/lists.h>

#include <string>

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
