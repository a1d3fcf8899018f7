// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/bounding_box.h>

#include <vector>

namespace PeriDeal
{
  /**
   * What has changed of a body from one time to another: made by the history of its cracks,
   * consumed by what holds bonds and cells, which mend only what it names.
   */
  template <int dim>
  struct ChangeSet
  {
    double from = 0., to = 0.; // representative times of the cracks (CrackHistory)
    double since = 0.;         // when those of `to` begin
    std::vector<dealii::BoundingBox<dim>> boxes; // around all that has changed; may be empty
  };
} // namespace PeriDeal
