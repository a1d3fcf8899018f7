// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/symmetric_tensor.h>

#include <vector>

namespace PeriDeal
{
  /**
   * At the nodes, for output: xx, yy, xy in 2D, xx, yy, zz, xy, xz, yz in 3D. In 2D, stresses out
   * of the plane where a law of stresses says them.
   */
  template <int dim>
  struct NodalTensors
  {
    std::vector<dealii::SymmetricTensor<2, dim>> stress, strain;
    std::vector<double>                          out_of_plane;
  };
} // namespace PeriDeal
