// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/point.h>

namespace PeriDeal
{
  /**
   * Whether a point comes before another in the order of their coordinates, the first one first:
   * what decides between equals in the same way on any number of processes. Not collective.
   */
  template <int dim>
  bool comes_first(const dealii::Point<dim> &a, const dealii::Point<dim> &b)
  {
    for (unsigned int d = 0; d < dim; ++d)
      if (a[d] != b[d])
        return a[d] < b[d];
    return false;
  }
} // namespace PeriDeal
