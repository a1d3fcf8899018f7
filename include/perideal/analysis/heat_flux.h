// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/dofs/dof_handler.h>

#include <perideal/base/types.h>
#include <perideal/bonds/diffusion_bonds.h>
#include <perideal/operators/diffusion/cell_term.h>

#include <array>

namespace PeriDeal
{
  /** One vector per coordinate direction. */
  template <int dim>
  using VectorField = std::array<Vector, dim>;

  /**
   * Peridynamic heat flux at the nodes, in two definitions that both give -kappa grad T for a
   * linear field far from the body's edge:
   *
   * two-sided (Diyaroglu 2017, eq 6):   q_i = -1/2 sum_j w V_j k_ij (T_j - T_i) xi,
   * one-sided (Bobaru 2012, section 2.2): q_i = -sum_{T_j > T_i} w V_j k_ij (T_j - T_i) xi.
   *
   * @param outside values of the fictitious nodes. u must have up-to-date ghosts. Not collective;
   *                the vectors must be initialized.
   */
  template <int dim>
  void bond_heat_flux(const DiffusionBonds<dim> &bonds,
                      const Vector              &u,
                      const std::vector<double> &outside,
                      VectorField<dim>          &two_sided,
                      VectorField<dim>          &one_sided);

  /**
   * The same where bonds stand beside finite elements: with all conductances of a node's row of K
   * in the place of w V_i V_j k_ij. -kappa grad T for a linear field inside the body and on its
   * straight sides. Beside the larger cells of a graded mesh it is that of the elements.
   */
  template <int dim>
  void coupled_heat_flux(const CellTerm<dim> &cells,
                         const Vector        &u,
                         VectorField<dim>    &two_sided,
                         VectorField<dim>    &one_sided);

  /** Part of each family (by volume) whose bonds cross a crack. Not collective. */
  template <int dim>
  void cut_fraction(const DiffusionBonds<dim> &bonds, Vector &fraction);

  /**
   * Finite element heat flux -kappa grad T at the vertices, as the mean over the adjacent cells by
   * volume. Cells that a crack cuts (@p cut, by active cell index) count only where a vertex has no
   * other: their gradient runs through the crack. u must have up-to-date ghosts. Values at dofs
   * that are not vertices (Q2, Q3) are their cells' means too. Collective.
   */
  template <int dim>
  void element_heat_flux(const dealii::DoFHandler<dim> &dofs,
                         const Material                &material,
                         const std::vector<bool>       &cut,
                         const Vector                  &u,
                         VectorField<dim>              &flux);
} // namespace PeriDeal
