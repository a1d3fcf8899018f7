// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/laws/lattice_family.h>

#include <vector>

namespace PeriDeal
{
  /*
   * Bounds beyond which a diffusion run says in a note what is wrong: for the notes, and for
   * studies that draw them.
   */

  /** Complete families conduct more or less than `Conductivity` by so much of it. */
  constexpr double tolerable_conductivity_error = 5e-3;

  /** Sides that cut families make the body narrower by so much of its width. */
  constexpr double tolerable_missing_share = 5e-3;

  /**
   * The width beside a side normal to an axis that conducts nothing of a linear field along the
   * side, in spacings: rows of nodes have less than a whole family.
   *
   * @param family    a whole one
   * @param first_row volume of the row on the side, in cells
   *
   * Not collective.
   */
  template <int dim>
  double missing_width(const std::vector<FamilyMember<dim>> &family,
                       const unsigned int                    axis,
                       const double                          first_row);
} // namespace PeriDeal
