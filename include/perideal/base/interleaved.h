// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/partitioner.h>

#include <memory>

namespace PeriDeal
{
  /**
   * The indices of all components of the nodes in a set: component c of node i is n_components i +
   * c.
   */
  dealii::IndexSet interleaved(const dealii::IndexSet &nodes, const unsigned int n_components);

  /**
   * The layout of vectors with several components at each node, interleaved: component c of the
   * node with local number i is the unknown n_components i + c, for owned nodes and ghosts.
   * Collective.
   */
  std::shared_ptr<const dealii::Utilities::MPI::Partitioner> interleaved(
    const dealii::Utilities::MPI::Partitioner &nodes,
    const unsigned int                         n_components);
} // namespace PeriDeal
