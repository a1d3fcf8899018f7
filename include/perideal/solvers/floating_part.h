// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/operator.h>

namespace PeriDeal
{
  /**
   * Throws UserError if a part of the body is connected with nothing that fixes the level of its solution, so that K is singular on it:
   * cracks have cut it off from all Dirichlet and convection sides. The message names one place in it and its number of unknowns.
   *
   * Parts are found on the graph of the surrogate matrix (nearest neighbours) and confirmed by the operator itself, which may have longer
   * bonds between them. Collective.
   */
  void check_no_floating_part(const Operator                               &op,
                              const dealii::TrilinosWrappers::SparseMatrix &surrogate);
} // namespace PeriDeal
