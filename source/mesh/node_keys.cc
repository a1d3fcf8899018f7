// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/fe/fe.h>

#include <perideal/base/instantiate.h>
#include <perideal/mesh/node_keys.h>

#include <algorithm>
#include <limits>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** Carries every bit of @p next, and of what was there, to all bits (splitmix64). */
    std::uint64_t mixed(const std::uint64_t before, const std::uint64_t next)
    {
      std::uint64_t x = before + 0x9e3779b97f4a7c15u + next;
      x               = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
      x               = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
      return x ^ (x >> 31);
    }
  } // namespace


  template <int dim>
  NodeKeys node_keys(const DoFHandler<dim> &dofs)
  {
    constexpr std::uint64_t              none  = std::numeric_limits<std::uint64_t>::max();
    const IndexSet                      &owned = dofs.locally_owned_dofs();
    NodeKeys                             keys(owned.n_elements(), none);
    std::vector<types::global_dof_index> of_cell;
    for (const auto &cell : dofs.active_cell_iterators())
      {
        if (cell->is_artificial())
          continue;
        std::uint64_t key = 0;
        for (const unsigned int part : cell->id().template to_binary<dim>())
          key = mixed(key, part);
        of_cell.resize(cell->get_fe().n_dofs_per_cell());
        cell->get_dof_indices(of_cell);
        for (unsigned int k = 0; k < of_cell.size(); ++k)
          if (owned.is_element(of_cell[k]))
            {
              // All cells of an owned unknown are known here, whoever owns them.
              std::uint64_t &own = keys[owned.index_within_set(of_cell[k])];
              own                = std::min(own, mixed(key, k));
            }
      }
    return keys;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(node_keys);
} // namespace PeriDeal
