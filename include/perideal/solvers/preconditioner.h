// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/interface/operator.h>

#include <memory>

namespace PeriDeal
{
  /**
   * Approximate inverse of a C + b K: algebraic multigrid (Trilinos ML) on the operator's surrogate
   * matrix, plus, where that is not K itself, the inverse diagonal. Multigrid on the nearest
   * neighbours' graph takes care of what varies slowly; on what varies fast it is too stiff by the
   * number of bonds in a family, and there K is its diagonal. Symmetric positive definite.
   */
  class MultigridPreconditioner
  {
  public:
    /** @param direct_up_to the most unknowns of a level that is solved directly */
    MultigridPreconditioner(const Operator &op, const unsigned int direct_up_to);
    ~MultigridPreconditioner();

    /** Set up for a C + b K. Collective. */
    void initialize(const double capacity_factor, const double stiffness_factor);

    /** The operator's surrogate. */
    const dealii::TrilinosWrappers::SparseMatrix &surrogate() const;

    /** y = P^{-1} x; entries that are not free are zero. Collective. */
    void vmult(Vector &y, const Vector &x) const;

  private:
    struct Data;

    const Operator       &op;
    const unsigned int    direct_up_to;
    std::unique_ptr<Data> data;
  };
} // namespace PeriDeal
