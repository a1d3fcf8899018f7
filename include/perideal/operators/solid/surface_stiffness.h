// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/solid/solid_bonds.h>

namespace PeriDeal
{
  /**
   * By how much families that end at surfaces make a body stiffer: Young's modulus along each axis,
   * over that of complete families, less 1. That of the mean over all nodes of what uniform strains
   * store, which the body as a whole comes near to when it is slender. Collective.
   */
  template <int dim>
  dealii::Tensor<1, dim> surface_stiffness(const SolidBonds<dim> &bonds);
} // namespace PeriDeal
