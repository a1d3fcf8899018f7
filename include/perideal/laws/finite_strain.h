// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

namespace PeriDeal
{
  /*
   * What laws of the deformed body, of Cauchy's stress sigma and rates of it, are in the undeformed
   * one, for which StressLaw has S and E. F is the deformation gradient, J its determinant.
   */

  /**
   * A step from the deformation gradient F_0 to F, as a rotation that is followed by a stretch:
   * F F_0^-1 = V R.
   */
  struct FiniteStep
  {
    /** Of displacement gradients F_0 - 1 and F - 1; F_0 has a positive determinant, F, too. */
    FiniteStep(const dealii::Tensor<2, 3> &before, const dealii::Tensor<2, 3> &now);

    /** R a R^T. */
    dealii::SymmetricTensor<2, 3> rotated(const dealii::SymmetricTensor<2, 3> &a) const;

    dealii::Tensor<2, 3>          rotation; // R
    dealii::SymmetricTensor<2, 3> stretch;  // ln V, with the digits of small ones
  };


  /** det(1 + G). */
  double volume_ratio(const dealii::Tensor<2, 3> &displacement_gradient);

  /** The strain of Green and Lagrange, E = (F^T F - 1)/2, of G = F - 1. */
  dealii::SymmetricTensor<2, 3> green_strain(const dealii::Tensor<2, 3> &displacement_gradient);

  /** S = J F^-1 sigma F^-T, the second stress of Piola and Kirchhoff. */
  dealii::SymmetricTensor<2, 3> second_stress(const dealii::Tensor<2, 3> &displacement_gradient,
                                              const dealii::SymmetricTensor<2, 3> &cauchy);

  /**
   * dS/dE of moduli c of Jaumann's rate: where F changes by l F, d = sym l, w = skw l,
   *
   *   d(J sigma) = J c : d + w J sigma - J sigma w.
   *
   * Since J sigma = F S F^T and dE = F^T d F it is F dS F^T = J (c : d - d sigma - sigma d), and
   * symmetric where c is.
   */
  dealii::SymmetricTensor<4, 3> second_tangent(const dealii::Tensor<2, 3> &displacement_gradient,
                                               const dealii::SymmetricTensor<2, 3> &cauchy,
                                               const dealii::SymmetricTensor<4, 3> &jaumann);
} // namespace PeriDeal
