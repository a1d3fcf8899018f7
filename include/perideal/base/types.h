// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/lac/la_parallel_vector.h>

namespace PeriDeal
{
  /**
   * The vector of unknowns of every model: owned values first, then the ghosts of the model's own
   * partitioner (horizon wide for peridynamics, one layer of cells for finite elements). Operators
   * exchange the ghosts they need themselves.
   */
  using Vector = dealii::LinearAlgebra::distributed::Vector<double>;
} // namespace PeriDeal
