// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/tensor.h>

namespace PeriDeal
{
  /**
   * What a family sums under unit stretches along each axis a, the others 0, with weights w of its
   * bonds: sum w xi_a^2, the dilatation, and sum w xi_a^4/x^2, the energy of the extensions but for
   * common factors.
   */
  template <int dim>
  struct StretchSums
  {
    dealii::Tensor<1, dim> dilatation, energy;

    void add(const dealii::Tensor<1, dim> &xi, const double w);
  };

  /** A complete family's sum over a family's own, for each axis. */
  template <int dim>
  dealii::Tensor<1, dim> axis_factors(const dealii::Tensor<1, dim> &complete,
                                      const dealii::Tensor<1, dim> &own);

  /**
   * Factor of a bond: the radius in its direction n of the ellipsoid whose half axes are the means
   * g of both ends' factors, (sum_a (n_a/g_a)^2)^(-1/2) (Madenci and Oterkus 2014, section 4.2).
   */
  template <int dim>
  double ellipsoid_factor(const dealii::Tensor<1, dim> &one,
                          const dealii::Tensor<1, dim> &other,
                          const dealii::Tensor<1, dim> &xi);
} // namespace PeriDeal
