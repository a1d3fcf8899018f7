// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/laws/finite_strain.h>

#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    Tensor<2, 3> gradient_of(const Tensor<2, 3> &displacement_gradient)
    {
      return displacement_gradient + Tensor<2, 3>(unit_symmetric_tensor<3>());
    }


    /** A a A^T. */
    SymmetricTensor<2, 3> carried(const Tensor<2, 3> &A, const SymmetricTensor<2, 3> &a)
    {
      return symmetrize(A * Tensor<2, 3>(a) * transpose(A));
    }
  } // namespace


  FiniteStep::FiniteStep(const Tensor<2, 3> &before, const Tensor<2, 3> &now)
  {
    const Tensor<2, 3> change = (now - before) * invert(gradient_of(before));
    // V^2 - 1
    const SymmetricTensor<2, 3> squares =
      2. * symmetrize(change) + symmetrize(change * transpose(change));
    SymmetricTensor<2, 3> inverse = unit_symmetric_tensor<3>(); // V^-1
    if (squares.norm() > 0.)
      {
        inverse = 0.;
        for (const auto &[square, axis] :
             eigenvectors(squares, SymmetricTensorEigenvectorMethod::jacobi))
          {
            const SymmetricTensor<2, 3> along = symmetrize(outer_product(axis, axis));
            stretch += 0.5 * std::log1p(square) * along;
            inverse += 1. / std::sqrt(1. + square) * along;
          }
      }
    rotation = Tensor<2, 3>(inverse) * gradient_of(change);
  }


  SymmetricTensor<2, 3> FiniteStep::rotated(const SymmetricTensor<2, 3> &a) const
  {
    return carried(rotation, a);
  }


  double volume_ratio(const Tensor<2, 3> &displacement_gradient)
  {
    return determinant(gradient_of(displacement_gradient));
  }


  SymmetricTensor<2, 3> green_strain(const Tensor<2, 3> &displacement_gradient)
  {
    return symmetrize(displacement_gradient) +
           0.5 * symmetrize(transpose(displacement_gradient) * displacement_gradient);
  }


  SymmetricTensor<2, 3> second_stress(const Tensor<2, 3>          &displacement_gradient,
                                      const SymmetricTensor<2, 3> &cauchy)
  {
    const Tensor<2, 3> F = gradient_of(displacement_gradient);
    return determinant(F) * carried(invert(F), cauchy);
  }


  SymmetricTensor<4, 3> second_tangent(const Tensor<2, 3>          &displacement_gradient,
                                       const SymmetricTensor<2, 3> &cauchy,
                                       const SymmetricTensor<4, 3> &jaumann)
  {
    const Tensor<2, 3>    F = gradient_of(displacement_gradient), inverse = invert(F);
    const double          J = determinant(F);
    SymmetricTensor<4, 3> result;
    for (unsigned int c = 0; c < 3; ++c)
      for (unsigned int d = c; d < 3; ++d)
        {
          SymmetricTensor<2, 3> strain;
          strain[c][d]                     = c == d ? 1. : 0.5; // both entries
          const SymmetricTensor<2, 3> rate = carried(transpose(inverse), strain);
          const SymmetricTensor<2, 3> of_rate =
            carried(inverse,
                    jaumann * rate - 2. * symmetrize(Tensor<2, 3>(rate) * Tensor<2, 3>(cauchy)));
          for (unsigned int a = 0; a < 3; ++a)
            for (unsigned int b = a; b < 3; ++b)
              result[a][b][c][d] = J * of_rate[a][b];
        }
    return result;
  }
} // namespace PeriDeal
