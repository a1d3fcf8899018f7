// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/point.h>
#include <deal.II/dofs/dof_handler.h>

#include <array>
#include <functional>
#include <vector>

namespace PeriDeal
{
  /**
   * A node and dim of its neighbours, one along each direction of the mesh: they span a corner of a
   * cell.
   */
  template <int dim>
  struct CellCorner
  {
    unsigned int                  node; // owned
    std::array<unsigned int, dim> others;
  };


  /**
   * All corners of owned nodes: of the cells around a vertex its neighbours along the edges, of a
   * node at the centre of a cell those at the centres of the cells beside it, where these are cells
   * of the same size. A node inside a plane has four, one inside a body in space eight. Not
   * collective.
   *
   * @param local_number of the node with a global index, or numbers::invalid_unsigned_int for those
   *                     that this process does not know. Corners with such nodes are left out.
   */
  template <int dim>
  std::vector<CellCorner<dim>> cell_corners(
    const dealii::DoFHandler<dim>                                            &dofs,
    const unsigned int                                                        n_owned,
    const std::function<unsigned int(const dealii::types::global_dof_index)> &local_number);


  /**
   * The volume that the corner spans over what it spanned in the undeformed mesh, by the places of
   * its nodes: 1 in a body at rest, also one that has been turned, zero or negative where nodes
   * have passed through each other.
   *
   * @param position of a node by local number; @param displacement dim numbers for each node,
   *                 interleaved
   */
  template <int dim, typename Position>
  double volume_ratio(const CellCorner<dim> &corner,
                      const Position        &position,
                      const double *const    displacement)
  {
    dealii::Tensor<2, dim> before, now;
    for (unsigned int a = 0; a < dim; ++a)
      {
        before[a] = position(corner.others[a]) - position(corner.node);
        now[a]    = before[a];
        for (unsigned int d = 0; d < dim; ++d)
          now[a][d] +=
            displacement[dim * corner.others[a] + d] - displacement[dim * corner.node + d];
      }
    return determinant(now) / determinant(before);
  }
} // namespace PeriDeal
