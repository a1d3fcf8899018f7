// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/solid/elastic_operator.h>

namespace PeriDeal
{
  /**
   * Throws UserError if a part of the body is connected with nothing that fixes the level of its
   * solution, so that K is singular on it: cracks have cut it off from all Dirichlet and convection
   * sides. The message names one place in it and its number of unknowns.
   *
   * Parts are found on the graph of the surrogate matrix (nearest neighbours) and confirmed by the
   * operator itself, which may have longer bonds between them.
   * @param is_guess K is that of a guess of the solution on which it depends
   *
   * Collective.
   */
  void check_no_floating_part(const Operator                               &op,
                              const dealii::TrilinosWrappers::SparseMatrix &surrogate,
                              const bool                                    is_guess = false);

  /**
   * Throws UserError if a part of a body can move without a strain and the forces on it do work
   * on that motion: cracks or voids have cut it off from its supports, and it has no equilibrium.
   * The message names one place in it, its number of nodes and the force. Parts that nothing holds
   * and whose forces balance pass.
   *
   * Parts are found as above, what they can do from the energies of their rigid motions with
   * prescribed unknowns at rest; the operator itself confirms it. Costs an application for each
   * rigid motion. Collective.
   *
   * @param residual of the free unknowns at a state that fulfils the conditions
   */
  void check_no_loose_part(const ElasticOperator                        &op,
                           const dealii::TrilinosWrappers::SparseMatrix &surrogate,
                           const Vector                                 &residual);
} // namespace PeriDeal
