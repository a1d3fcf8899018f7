// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/body_parameters.h>

#include <array>

namespace PeriDeal
{
  /**
   * Sides of the box with `Displacement` that hold the side itself, half a cell outside of the
   * outermost row of nodes at cell centers, which follows (HeldRows). All with nodes at cell
   * centers beyond which families go on, but for
   *
   * - those with a `Displacement layer`, whose nodes are held at the values of their own places;
   * - bodies whose bonds may break, and sides within two cells of a crack: a row that has parted
   *   from the one behind it does not follow that one;
   * - bodies of one cell across, or of two with displacements at both ends.
   *
   * There the outermost row has the displacement of the side. Not collective.
   */
  template <int dim>
  std::array<bool, 2 * dim> sides_held_themselves(const BodyParameters<dim> &body);
} // namespace PeriDeal
