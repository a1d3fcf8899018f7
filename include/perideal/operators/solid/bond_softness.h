// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/solid/bond_table.h>

namespace PeriDeal
{
  template <int dim>
  BondSoftness softness_of(const BondTable<dim> &bonds, const std::size_t number)
  {
    const double *const numbers =
      bonds.rows_of(number).nonlinear.history.data() + BondSoftness::n * bonds.place(number);
    return {numbers[0], numbers[1]};
  }


  /** Of a whole bond, of which something is left. */
  template <int dim>
  void weaken(BondTable<dim> &bonds, const std::size_t number, const BondSoftness &now);
} // namespace PeriDeal
