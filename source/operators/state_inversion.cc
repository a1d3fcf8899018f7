// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// How far the body is deformed, and where it is inside out.

#include <deal.II/base/mpi.h>

#include <perideal/operators/state_operator.h>

#include <algorithm>
#include <cmath>

#include "inversion.h"
#include "state_lattice.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  double StateOperator<dim>::largest_stretch(const Vector &u) const
  {
    if (!full)
      return 0.;
    double largest = 0.;
    u.update_ghost_values();
    for (unsigned int i = 0; i < bonds.nodes().n_owned(); ++i)
      for (std::size_t k = starts[i]; k < starts[i + 1]; ++k)
        if (state.is_whole(k))
          largest = std::max(largest,
                             std::abs(deformed_bond(u.begin(), i, neighbors[k]).norm() /
                                        bonds.neighbors().bond_vector(i, neighbors[k]).norm() -
                                      1.));
    u.set_ghost_state(false);
    return Utilities::MPI::max(largest, bonds.nodes().communicator());
  }


  template <int dim>
  bool StateOperator<dim>::holds(const CellCorner<dim> &corner) const
  {
    const unsigned int i = corner.node;
    if (!on_lattice.empty() && on_lattice[i])
      return true;
    unsigned int n_found = 0;
    for (std::size_t k = starts[i]; k < starts[i + 1]; ++k)
      {
        if (!state.is_whole(k))
          return false;
        if (std::find(corner.others.begin(), corner.others.end(), neighbors[k]) !=
            corner.others.end())
          ++n_found;
      }
    return n_found == dim; // no crack of the scene has cut one
  }


  template <int dim>
  Inversion StateOperator<dim>::inverted(const Vector &u) const
  {
    const Nodes<dim> &nodes  = bonds.nodes();
    const auto       &layout = *nodes.partitioner();
    if (corners.empty())
      corners = cell_corners<dim>(nodes.dof_handler(),
                                  nodes.n_owned(),
                                  [&](const types::global_dof_index i) {
                                    return layout.in_local_range(i) || layout.is_ghost_entry(i) ?
                                             layout.global_to_local(i) :
                                             numbers::invalid_unsigned_int;
                                  });
    u.update_ghost_values();
    const Inversion result = find_inverted<dim>(
      corners,
      u,
      [&](const unsigned int node) { return nodes.position(node); },
      [&](const CellCorner<dim> &corner) { return holds(corner); },
      nodes.communicator());
    u.set_ghost_state(false);
    return result;
  }


#define PERIDEAL_INSTANTIATE(dim)                                               \
  template double    StateOperator<dim>::largest_stretch(const Vector &) const; \
  template Inversion StateOperator<dim>::inverted(const Vector &) const;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
