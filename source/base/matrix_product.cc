// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/exceptions.h>

#include <perideal/base/matrix_product.h>

#include <Epetra_CrsMatrix.h>
#include <Epetra_MultiVector.h>

namespace PeriDeal
{
  using namespace dealii;

  MatrixProduct::MatrixProduct(const TrilinosWrappers::SparseMatrix &matrix)
    : matrix(matrix)
  {}


  void MatrixProduct::multiply(const bool transposed, Vector &y, const Vector &x) const
  {
    Assert(&x != &y, ExcMessage("Source and destination must not be the same."));
    const Epetra_CrsMatrix &rows = matrix.trilinos_matrix();
    const auto              size = static_cast<int>(x.locally_owned_size());
    AssertDimension(size, rows.DomainMap().NumMyElements());
    AssertDimension(static_cast<int>(y.locally_owned_size()), rows.RangeMap().NumMyElements());
    const Epetra_MultiVector from(::View,
                                  transposed ? rows.RangeMap() : rows.DomainMap(),
                                  const_cast<double *>(x.begin()),
                                  size,
                                  1);
    Epetra_MultiVector       to(::View,
                          transposed ? rows.DomainMap() : rows.RangeMap(),
                          y.begin(),
                          size,
                          1);
    const int                error = rows.Multiply(transposed, from, to);
    AssertThrow(error == 0, ExcTrilinosError(error));
  }


  void MatrixProduct::vmult(Vector &y, const Vector &x) const
  {
    multiply(false, y, x);
  }


  void MatrixProduct::Tvmult(Vector &y, const Vector &x) const
  {
    multiply(true, y, x);
  }
} // namespace PeriDeal
