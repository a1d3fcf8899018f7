// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/solid/solid_bonds.h>

namespace dealii::TrilinosWrappers
{
  class SparseMatrix;
}

namespace PeriDeal
{
  /**
   * The diagonal of K without conditions; positive numbers where all bonds of a node have broken.
   * Collective.
   */
  template <int dim>
  void find_stiffness_diagonal(const SolidBonds<dim> &bonds, Vector &diagonal);

  /**
   * The same of some owned nodes, whose bonds have changed. Only where families end at the sides.
   * Not collective.
   */
  template <int dim>
  void mend_stiffness_diagonal(const SolidBonds<dim>           &bonds,
                               const std::vector<unsigned int> &of_nodes,
                               Vector                          &diagonal);


  /**
   * By node: c d/(q^2 V), whole, times the sum of the lengths of what theta takes displacements by,
   * an upper bound of it. Ghosts are up to date. Collective.
   */
  template <int dim>
  Vector find_sums_of_dilatations(const SolidBonds<dim> &bonds);


  /**
   * Sums over the rows of |K|, with the norms of its blocks, by node: twice the springs, and for
   * the dilatations |c_ij| summed over both of their ends. Collective.
   *
   * @param of_dilatations of find_sums_of_dilatations(), or 0: without them
   * @param of_tangent     with the stiffness across bonds
   */
  template <int dim>
  Vector find_row_sums(const SolidBonds<dim> &bonds,
                       const Vector          &of_dilatations,
                       const bool             of_tangent);


  /**
   * Springs between the nearest nodes, diagonals of cells included, as stiff as the bond-based
   * solid: Operator::surrogate(). @p diagonal is that of K, @p held positive on unknowns that are
   * not free, its ghosts up to date. Collective.
   */
  template <int dim>
  void make_surrogate(const SolidBonds<dim>                  &bonds,
                      const BodyParameters<dim>              &body,
                      const Vector                           &diagonal,
                      const Vector                           &held,
                      dealii::TrilinosWrappers::SparseMatrix &matrix);
} // namespace PeriDeal
