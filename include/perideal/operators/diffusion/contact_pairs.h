// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/dofs/dof_handler.h>

#include <perideal/scene/cracks.h>

#include <vector>

namespace PeriDeal
{
  /**
   * Two unknowns at one place of a crack that is cut into the mesh, and what passes between them:
   * H times the integral of the shape function over the faces that they share, so that a crack
   * whose sides have a temperature each lets through H times its area times their difference.
   */
  struct ContactPair
  {
    dealii::types::global_dof_index own, other;
    double                          conductance;
    unsigned int                    crack;
    int                             side; // 1 where the own unknown lies on the crack's left, or -1
  };

  /**
   * The pairs whose first unknown this process owns, so that each comes up at both of its ends;
   * none without a contact conductance on faces. A pair comes in a part for each face and cell.
   *
   * Collective.
   */
  template <int dim>
  std::vector<ContactPair> contact_pairs(const dealii::DoFHandler<dim> &dofs,
                                         const Cracks<dim>             &cracks);
} // namespace PeriDeal
