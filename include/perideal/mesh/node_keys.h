// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/dofs/dof_handler.h>

#include <perideal/base/archive.h>

namespace PeriDeal
{
  /**
   * Keys of the owned unknowns of one number at each node: the cells that a node is part of and
   * its place in them, so that nodes on the two sides of a crack differ. Not collective.
   */
  template <int dim>
  NodeKeys node_keys(const dealii::DoFHandler<dim> &dofs);
} // namespace PeriDeal
