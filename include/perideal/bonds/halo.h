// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/mesh/nodes.h>

namespace PeriDeal
{
  /**
   * What a process needs the neighbourhood of: its nodes, for their bonds; or its cells and ghost
   * cells, for all bonds that pass through its cells, and all nodes on the way.
   */
  enum class HaloAround
  {
    nodes,
    cells
  };


  /**
   * Give each process copies of all nodes of others that may be bonded to its own. deal.II's
   * distributed meshes know one layer of ghost cells only, a horizon reaches over m of them: so
   * every process tells all others a few boxes around its nodes, and receives the nodes that lie
   * within @p reach of a box. The halo may hold a few nodes that no bond needs. Collective.
   */
  template <int dim>
  void add_halo(Nodes<dim> &nodes, const double reach, const HaloAround around = HaloAround::nodes);
} // namespace PeriDeal
