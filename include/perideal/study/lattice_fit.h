// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <vector>

namespace PeriDeal
{
  /** What a number was on a lattice. */
  struct OnLattice
  {
    double spacing = 0.; // in any unit
    double value   = 0.;
  };


  /** What some lattices say of one without end: value = limit + slope spacing, by least squares. */
  struct LatticeFit
  {
    double limit       = 0.;
    double slope       = 0.;
    double scatter     = 0.;    // root mean square about the line, for as many as it leaves free
    double uncertainty = 0.;    // of the limit, as the scatter has it: its standard error
    bool   is_known    = false; // needs three
  };

  LatticeFit fit_of_lattices(const std::vector<OnLattice> &found);

  /**
   * By how much the value on the last lattice, the finest, may differ from the limit: by what the
   * line says, and twice the uncertainty of that. Negative if too little is known.
   */
  double error_of_last(const std::vector<OnLattice> &found);
} // namespace PeriDeal
