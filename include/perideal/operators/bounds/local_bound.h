// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <perideal/base/types.h>
#include <perideal/operators/interface/row_set.h>

namespace PeriDeal
{
  /**
   * The bound of sharp_bound() for a symmetric matrix K, when iterations start with values in a few
   * rows only. After k of them vectors are zero farther than k entries of the matrix away from
   * these, and rows beyond are not visited: the numbers are those of iterations on the whole body,
   * but their cost follows from the number of rows to start with.
   */
  class LocalBound
  {
  public:
    explicit LocalBound(const Vector &layout);

    /**
     * @param held   rows that are not free
     * @param first  where iterations start, with the values of @p start
     *
     * Returns a negative number if an entry needed lies in a column that this process does not
     * know. Collective.
     */
    double operator()(const dealii::TrilinosWrappers::SparseMatrix &stiffness,
                      const Vector                                 &capacity,
                      const RowSet                                 &held,
                      const std::vector<unsigned int>              &first,
                      const Vector                                 &start,
                      const double                                  enough);

  private:
    void grow(const dealii::TrilinosWrappers::SparseMatrix &stiffness);

    Vector              values; // zero but for the rows of the set
    RowSet              rows;
    std::size_t         n_grown = 0; // rows whose neighbours are in the set
    bool                unknown = false;
    std::vector<double> root;            // of the capacity, of each row in turn
    std::vector<double> last, now, next; // likewise
  };
} // namespace PeriDeal
