// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <perideal/laws/stress_law.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  /** Without what is out of the body. */
  template <int dim>
  StressLaw::Tensor in_space(const dealii::SymmetricTensor<2, dim> &part)
  {
    StressLaw::Tensor full;
    for (unsigned int a = 0; a < dim; ++a)
      for (unsigned int b = a; b < dim; ++b)
        full[a][b] = part[a][b];
    return full;
  }


  template <int dim>
  dealii::Tensor<2, 3> in_space(const dealii::Tensor<2, dim> &part)
  {
    dealii::Tensor<2, 3> full;
    for (unsigned int a = 0; a < dim; ++a)
      for (unsigned int b = 0; b < dim; ++b)
        full[a][b] = part[a][b];
    return full;
  }


  /** What is in the body. */
  template <int dim>
  dealii::SymmetricTensor<2, dim> in_body(const StressLaw::Tensor &full)
  {
    dealii::SymmetricTensor<2, dim> part;
    for (unsigned int a = 0; a < dim; ++a)
      for (unsigned int b = a; b < dim; ++b)
        part[a][b] = full[a][b];
    return part;
  }


  /** F of a displacement gradient. */
  template <int dim>
  dealii::Tensor<2, dim> deformation_of(const dealii::Tensor<2, dim> &gradient)
  {
    return gradient + dealii::Tensor<2, dim>(dealii::unit_symmetric_tensor<dim>());
  }


  /** The strain of Green and Lagrange, with the digits of small gradients. */
  template <int dim>
  dealii::SymmetricTensor<2, dim> strain_of(const dealii::Tensor<2, dim> &gradient)
  {
    return symmetrize(gradient) + 0.5 * symmetrize(transpose(gradient) * gradient);
  }


  /** What a law of large deformations says, as the force per area of the deformed body. */
  template <int dim>
  StressLaw::Tensor cauchy_stress(const dealii::Tensor<2, dim> &gradient,
                                  const StressLaw::Response    &response)
  {
    const dealii::Tensor<2, 3> F =
      in_space(gradient) + dealii::Tensor<2, 3>(dealii::unit_symmetric_tensor<3>());
    return symmetrize(F * dealii::Tensor<2, 3>(response.stress) * transpose(F)) /
           (determinant(F) * response.stretch);
  }


  /**
   * Of such a strain: the excess of a stiffness over that at rest, roughly. What is pressed
   * together along a direction, or gets wider across it, is stiffer.
   */
  template <int dim>
  double stiffening_of(const dealii::SymmetricTensor<2, dim> &strain)
  {
    double J2 = 1., least = 1.; // squares
    for (const double value : eigenvalues(strain))
      {
        J2 *= 1. + 2. * value;
        least = std::min(least, 1. + 2. * value);
      }
    return std::max(1., J2) / least - 1.;
  }
} // namespace PeriDeal
