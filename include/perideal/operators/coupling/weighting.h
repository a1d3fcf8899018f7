// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/coupling_control.h>

#include <memory>

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
    virtual ~Weighting() = default;

    virtual double of_family(const double beta) const = 0;
    virtual double of_row(const double beta) const    = 0;

    /** What finite elements keep of a cell with that mean of beta. */
    virtual double of_cell(const double mean) const = 0;

    /** What they keep of the row of a node. */
    virtual double of_cell_row(const double beta) const = 0;

    /** What comes of symmetric matrices is symmetric. */
    virtual bool symmetric() const = 0;

    /** Of a bond in the row of its first end. */
    double of_bond(const double own, const double neighbor) const
    {
      return of_row(own) * 0.5 * (of_family(own) + of_family(neighbor));
    }
  };

  /** Of `blending` or `splice`; null for `exchange`, which weighs nothing. */
  std::unique_ptr<const Weighting> make_weighting(const CouplingScheme scheme);
} // namespace PeriDeal
