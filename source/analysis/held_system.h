// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/lac/trilinos_precondition.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>

#include <perideal/base/types.h>

namespace PeriDeal
{
  /**
   * A body with and without bonds whose surface is held, and how to invert its K to a few digits.
   * All functions are collective.
   */
  class HeldSystem
  {
  public:
    /**
     * @param matrix K with bonds; has to live on, like the next
     * @param elements K without
     * @param held 1 at unknowns that are held, 0 elsewhere
     * @param n_components unknowns of a node
     */
    HeldSystem(const dealii::TrilinosWrappers::SparseMatrix &matrix,
               const dealii::TrilinosWrappers::SparseMatrix &elements,
               const Vector                                 &held,
               const bool                                    symmetric,
               const unsigned int                            n_components);

    /**
     * Largest difference between the solution with bonds and that without for the loads and surface
     * values of u, which is the latter, over the largest value of u.
     */
    double patch_error(const Vector &u) const;

    /** The largest |(K - K^T) x|/|K x| for some fields x. */
    double asymmetry(const Vector &noise) const;

    /**
     * Of C^{-1} K, by inverse iterations, with the Rayleigh quotient at the end. Infinite if all
     * unknowns are held.
     */
    double lowest_eigenvalue(const Vector &noise, const Vector &capacity) const;

  private:
    void clear_held(Vector &v) const;
    void solve(Vector &x, const Vector &b) const;

    const dealii::TrilinosWrappers::SparseMatrix &matrix, &elements;
    const Vector                                  held;
    const bool                                    symmetric;
    dealii::TrilinosWrappers::SparseMatrix        inner,
      inner_elements; // the latter lives as long as its preconditioner
    dealii::TrilinosWrappers::PreconditionAMG preconditioner;
  };
} // namespace PeriDeal
