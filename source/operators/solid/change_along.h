// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/tensor.h>

namespace PeriDeal
{
  /** a . (far - own), of displacements of two nodes. */
  template <int dim>
  inline double change_along(const dealii::Tensor<1, dim> &a, const double *own, const double *far)
  {
    double sum = 0.;
    for (unsigned int d = 0; d < dim; ++d)
      sum += a[d] * (far[d] - own[d]);
    return sum;
  }


  /** a . (u_j - u_i), of displacements whose components are interleaved. */
  template <int dim>
  inline double change_along(const dealii::Tensor<1, dim> &a,
                             const double                 *u,
                             const unsigned int            i,
                             const unsigned int            j)
  {
    return change_along(a, u + dim * i, u + dim * j);
  }
} // namespace PeriDeal
