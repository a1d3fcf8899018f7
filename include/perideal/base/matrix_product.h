// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <perideal/base/types.h>

namespace PeriDeal
{
  /**
   * A sparse matrix A as what solvers multiply by. deal.II's own functions for these vectors are
   * templates that are compiled into its library, under a name that GCC and Clang make differently:
   * PeriDeal compiled by the one would not find what the other has compiled.
   */
  class MatrixProduct
  {
  public:
    /** The matrix has to outlive this. */
    explicit MatrixProduct(const dealii::TrilinosWrappers::SparseMatrix &matrix);

    /** y = A x; vectors with the layout of the rows. Collective. Ghosts of y are not updated. */
    void vmult(Vector &y, const Vector &x) const;

    /** y = A^T x. */
    void Tvmult(Vector &y, const Vector &x) const;

  private:
    void multiply(const bool transposed, Vector &y, const Vector &x) const;

    const dealii::TrilinosWrappers::SparseMatrix &matrix;
  };
} // namespace PeriDeal
