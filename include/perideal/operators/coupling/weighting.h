// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/coupling_control.h>

#include <algorithm>

namespace PeriDeal
{
  /**
   * What splice and blending make of the weight beta of peridynamics at a node: a factor of the
   * energy of its family, and one of its row. A bond belongs to the families of both of its ends in
   * equal parts.
   */
  class Weighting
  {
  public:
    /** @param scheme `blending` or `splice`; `exchange` weighs nothing */
    explicit Weighting(const CouplingScheme scheme)
      : rows(scheme == CouplingScheme::splice)
    {}

    double of_family(const double beta) const
    {
      return rows ? 1. : beta;
    }

    double of_row(const double beta) const
    {
      return rows ? beta : 1.;
    }

    /** What finite elements keep of a cell with that mean of beta. */
    double of_cell(const double mean) const
    {
      return rows ? 1. : std::max(0., 1. - mean);
    }

    /** What they keep of the row of a node. */
    double of_cell_row(const double beta) const
    {
      return rows ? 1. - beta : 1.;
    }

    /** What comes of symmetric matrices is symmetric. */
    bool symmetric() const
    {
      return !rows;
    }

    /** Of a bond in the row of its first end. */
    double of_bond(const double own, const double neighbor) const
    {
      return of_row(own) * 0.5 * (of_family(own) + of_family(neighbor));
    }

  private:
    bool rows; // are weighed, and not energies
  };
} // namespace PeriDeal
