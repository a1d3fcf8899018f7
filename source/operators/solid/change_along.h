// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/tensor.h>

namespace PeriDeal
{
  /** a . (u_j - u_i), of displacements whose components are interleaved. */
  template <int dim>
  inline double change_along(const dealii::Tensor<1, dim> &a,
                             const double                 *u,
                             const unsigned int            i,
                             const unsigned int            j)
  {
    double sum = 0.;
    for (unsigned int d = 0; d < dim; ++d)
      sum += a[d] * (u[dim * j + d] - u[dim * i + d]);
    return sum;
  }
} // namespace PeriDeal
