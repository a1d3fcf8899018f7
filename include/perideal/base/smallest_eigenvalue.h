// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/symmetric_tensor.h>

#include <Eigen/Eigenvalues>

namespace PeriDeal
{
  /**
   * The smallest eigenvalue of a symmetric tensor, to round-off of the largest one whatever the
   * tensor: isotropic (families inside a body), of rank one (bonds in one line) or zero. The closed
   * forms of dealii::eigenvalues() are not: of a nearly isotropic tensor in two dimensions they
   * take the root of a negative number, and of one of rank one in three dimensions they leave 1e-8
   * of its trace. An entry that is not finite gives a number that is not finite.
   */
  template <int dim>
  double smallest_eigenvalue(const dealii::SymmetricTensor<2, dim> &tensor)
  {
    if constexpr (dim == 1)
      return tensor[0][0];
    else
      {
        Eigen::Matrix<double, dim, dim> matrix;
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int j = 0; j < dim; ++j)
            matrix(i, j) = tensor[i][j];
        // By iteration: computeDirect() is a closed form too.
        return Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, dim, dim>>(
                 matrix,
                 Eigen::EigenvaluesOnly)
          .eigenvalues()[0];
      }
  }
} // namespace PeriDeal
