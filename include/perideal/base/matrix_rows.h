// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <perideal/base/types.h>

#include <Epetra_CrsMatrix.h>

namespace PeriDeal
{
  /**
   * Call visit(column, value) for each stored entry of one row of this process, as for_each_entry()
   * does.
   */
  template <typename Visit>
  void for_each_entry_of_row(const dealii::TrilinosWrappers::SparseMatrix &matrix,
                             const unsigned int                            row,
                             const Visit                                  &visit)
  {
    const Epetra_CrsMatrix &rows      = matrix.trilinos_matrix();
    const Epetra_Map       &columns   = rows.ColMap();
    int                     n_entries = 0, *indices = nullptr;
    double                 *values = nullptr;
    rows.ExtractMyRowView(static_cast<int>(row), n_entries, values, indices);
    for (int k = 0; k < n_entries; ++k)
      visit(static_cast<dealii::types::global_dof_index>(columns.GID(indices[k])), values[k]);
  }


  /**
   * Call visit(row, column, value) for each stored entry of the rows of this process, with the
   * local number of the row, the global number of the column and a reference to the value, which
   * may be changed. deal.II's iterators copy each row and write through a search; on matrices of a
   * million entries that shows. Not collective; the matrix must be compressed.
   */
  template <typename Visit>
  void for_each_entry(const dealii::TrilinosWrappers::SparseMatrix &matrix, const Visit &visit)
  {
    const unsigned int n_rows = static_cast<unsigned int>(matrix.trilinos_matrix().NumMyRows());
    for (unsigned int row = 0; row < n_rows; ++row)
      for_each_entry_of_row(matrix, row, [&](const auto column, double &value) {
        visit(row, column, value);
      });
  }


  /**
   * The owned values of a vector with all columns of a matrix as ghosts, which hanging nodes carry
   * beyond the halo. Collective.
   */
  Vector with_columns_as_ghosts(const Vector                                 &v,
                                const dealii::TrilinosWrappers::SparseMatrix &matrix);

  /**
   * Clear rows and columns of the unknowns that are marked by a number above 0, and put 1 on their
   * diagonal. Collective.
   */
  void hold_unknowns(dealii::TrilinosWrappers::SparseMatrix &matrix, const Vector &marked);
} // namespace PeriDeal
