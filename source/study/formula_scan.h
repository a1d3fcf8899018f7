// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/scene.h>

#include <vector>

#include "body_of_choice.h"

namespace PeriDeal
{
  /** What a mesh has to have for the formulas of a scene. */
  struct NeedsOfFormulas
  {
    double fineness = 1.;    // cells along the longest edge
    bool   jumps    = false; // within cells: errors get smaller only as cells do, unevenly
    bool   disagree = false; // given_values_disagree(): the same, but at corners

    double rough_order = 0.; // order_of_rough_places()
  };


  /**
   * How many cells along the longest edge of the box around a body its formulas need: the fewest,
   * of powers of two, on which the linear interpolant of each is right to a fifth of its variation
   * in the mean square, cells being as long as wide. Sources, materials, forces and initial fields
   * in the body, what is given on its sides, and the parts that it is given on; formulas of time
   * are looked at four times. A layer that grows from the sides needs some cells, too
   * (fineness_of_first_layer()). At most as many as are looked at. A solution on coarser cells may
   * have missed what they describe.
   *
   * Jumps are looked for in what makes the solution rough: materials, given values, initial fields,
   * and parts of sides where values are given. Of a function that jumps the interpolant on the
   * finest raster is wrong by more than half of what it is on one twice as coarse. Not collective.
   * @param materials_on_lines cells are of one material each, so that it may jump between them
   */
  template <int dim>
  NeedsOfFormulas needs_of_formulas(const BodyOfChoice<dim> &body, const bool materials_on_lines);

  /**
   * The fineness of those needs with cells that are short in one direction alone, for each
   * direction; what is given on a side needs them in all, since it fades as fast away from it.
   * Takes some times as long. Not collective.
   */
  template <int dim>
  std::vector<double> needs_along_edges(const BodyOfChoice<dim> &body);
} // namespace PeriDeal
