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
   * K of these bonds without conditions; rows hold some (4m)^dim nodes (bond-based: (2m)^dim). @p
   * state is that of the stored bonds, @p unknowns the layout of displacements. Collective.
   */
  template <int dim>
  void assemble_matrix(const SolidBonds<dim>                     &bonds,
                       const BondState                           &state,
                       const dealii::Utilities::MPI::Partitioner &unknowns,
                       dealii::TrilinosWrappers::SparseMatrix    &matrix);


  /**
   * Springs between the nearest nodes, diagonals of cells included, as stiff as the bond-based
   * solid: Operator::surrogate(). @p diagonal is that of K, @p held positive on unknowns that are
   * not free, its ghosts up to date. Collective.
   */
  template <int dim>
  void make_surrogate(const SolidBonds<dim>                  &bonds,
                      const BondState                        &state,
                      const BodyParameters<dim>              &body,
                      const Vector                           &diagonal,
                      const Vector                           &held,
                      dealii::TrilinosWrappers::SparseMatrix &matrix);
} // namespace PeriDeal
