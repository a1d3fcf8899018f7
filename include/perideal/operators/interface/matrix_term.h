// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <perideal/operators/interface/term.h>

#include <vector>

namespace PeriDeal
{
  /**
   * A term that is a matrix: what has been assembled of cells, and of bonds and sides if these are
   * no terms of their own. As the first term it is multiplied by as it is; beside another term only
   * few rows have entries, and these are kept (keep_rows()).
   */
  template <int dim>
  class MatrixTerm : public Term<dim>
  {
  public:
    using typename Term<dim>::At;
    using typename Term<dim>::Rows;

    /** @param first of the terms */
    MatrixTerm(const bool first, const bool is_symmetric)
      : first(first)
      , is_symmetric(is_symmetric)
    {}

    /**
     * Beside another term: take the rows of the matrix that are not empty. Its columns are owned
     * or ghosts of the layout. Collective.
     */
    void keep_rows(const dealii::Utilities::MPI::Partitioner &layout);

    void add(Vector            &y,
             const At          &at,
             const unsigned int begin,
             const unsigned int end) const override;
    void set_then(Vector &y, const At &at, const Operator::RowsAction &finish) const override;
    void add_rows(Vector &diagonal, std::vector<double> &sums, const Rows &rows) const override;
    void add_to(OperatorSize &size) const override;
    bool symmetric() const override
    {
      return is_symmetric;
    }

    dealii::TrilinosWrappers::SparseMatrix matrix;

  protected:
    /**
     * For terms of which a part is renewed often: keep the matrix before that part is added, and be
     * it again. Not by subtraction, for then digits depend on how often.
     */
    void keep_matrix()
    {
      kept_matrix.copy_from(matrix);
    }

    void restore_matrix()
    {
      matrix.copy_from(kept_matrix);
    }

  private:
    /** Rows by local numbers. */
    struct Kept
    {
      std::vector<unsigned int> rows, starts, columns;
      std::vector<double>       values;
    };

    const bool                             first, is_symmetric;
    Kept                                   kept;
    dealii::TrilinosWrappers::SparseMatrix kept_matrix;
  };
} // namespace PeriDeal
