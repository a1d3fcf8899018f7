// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/mesh/node_search.h>

namespace PeriDeal
{
  /**
   * Give each process copies of all nodes of others that may be bonded to its own. deal.II's
   * distributed meshes know one layer of ghost cells only, a horizon reaches over m of them: so
   * every process tells all others a few boxes around its nodes, and receives the nodes that lie
   * within reach of a box. The halo may hold a few nodes that no bond needs. Collective.
   */
  template <int dim>
  void add_halo(Nodes<dim> &nodes, const HaloNeed &need);

  /**
   * Let the nodes have a halo and a search that cover what is needed: the first who has bonds on
   * them makes both, all others share them. Those who need more than the first have to ask before
   * it (problems/model.h). Collective.
   * @param margin of the search
   */
  template <int dim>
  void prepare_search(Nodes<dim>                         &nodes,
                      const HaloNeed                     &need,
                      const typename Lattice<dim>::Index &margin);
} // namespace PeriDeal
