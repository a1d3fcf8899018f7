// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/dofs/dof_handler.h>

#include <perideal/base/types.h>
#include <perideal/scene/material.h>

#include <vector>

namespace PeriDeal
{
  /** By how much fluxes that are smooth differ from those of the elements. */
  struct RecoveryIndicators
  {
    std::vector<double>
           squares;     // integral of |q* - q|^2/kappa over each owned cell, by active cell index
    double energy = 0.; // integral of |q|^2/kappa over the body
    double size   = 0.; // integral of kappa u^2, by which round-off is told from a flux
  };

  /**
   * Error indicators by recovery (Zienkiewicz and Zhu 1987): q = -kappa grad u in each cell against
   * q*, its mean over the cells around each node, interpolated. Cut cells, in which the gradient
   * means nothing, have none and count for no other.
   *
   * @param cut cells that a crack cuts, by active cell index
   * @param u   with up-to-date ghosts
   * Collective.
   */
  template <int dim>
  RecoveryIndicators recovery_indicators(const dealii::DoFHandler<dim> &dofs,
                                         const Material                &material,
                                         const std::vector<bool>       &cut,
                                         const Vector                  &u);
} // namespace PeriDeal
