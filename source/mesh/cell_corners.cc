// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/geometry_info.h>

#include <perideal/base/instantiate.h>
#include <perideal/mesh/cell_corners.h>

#include <algorithm>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    using Cell = typename DoFHandler<dim>::active_cell_iterator;


    /** The node at the centre of the cell beside a face, or invalid_dof_index. */
    template <int dim>
    types::global_dof_index node_beside(const Cell<dim> &cell, const unsigned int face)
    {
      if (cell->at_boundary(face) || cell->neighbor_is_coarser(face) ||
          !cell->neighbor(face)->is_active() || cell->neighbor(face)->is_artificial())
        return numbers::invalid_dof_index;
      std::vector<types::global_dof_index> index(1);
      const Cell<dim>                      neighbor = cell->neighbor(face);
      neighbor->get_dof_indices(index);
      return index[0];
    }
  } // namespace


  template <int dim>
  std::vector<CellCorner<dim>> cell_corners(
    const DoFHandler<dim>                                            &dofs,
    const unsigned int                                                n_owned,
    const std::function<unsigned int(const types::global_dof_index)> &local_number)
  {
    const bool                           at_vertices = dofs.get_fe().n_dofs_per_vertex() > 0;
    std::vector<types::global_dof_index> indices(dofs.get_fe().n_dofs_per_cell());
    std::vector<CellCorner<dim>>         corners;
    for (const auto &cell : dofs.active_cell_iterators())
      {
        if (cell->is_artificial() || (!at_vertices && !cell->is_locally_owned()))
          continue;
        cell->get_dof_indices(indices);
        for (unsigned int k = 0; k < GeometryInfo<dim>::vertices_per_cell; ++k)
          {
            // Nodes of vertices come first; bit d of a vertex's number says on which side it lies.
            CellCorner<dim> corner;
            corner.node = local_number(indices[at_vertices ? k : 0]);
            if (corner.node >= n_owned)
              continue;
            for (unsigned int d = 0; d < dim; ++d)
              {
                const types::global_dof_index other =
                  at_vertices ? indices[k ^ (1u << d)] :
                                node_beside<dim>(cell, 2 * d + ((k >> d) & 1u));
                corner.others[d] = other == numbers::invalid_dof_index ?
                                     numbers::invalid_unsigned_int :
                                     local_number(other);
              }
            if (std::find(corner.others.begin(),
                          corner.others.end(),
                          numbers::invalid_unsigned_int) == corner.others.end())
              corners.push_back(corner);
          }
      }
    return corners;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(cell_corners);
} // namespace PeriDeal
