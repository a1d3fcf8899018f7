// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/solid/nodal_tensors.h>
#include <perideal/operators/solid/solid_bonds.h>

#include <vector>

namespace PeriDeal
{
  /** theta of the owned nodes, thermal extension taken off. Collective. */
  template <int dim>
  std::vector<double> nodal_dilatations(const SolidBonds<dim> &bonds, const Vector &u);


  /**
   * The collapsed stress of the owned nodes, sum_j t_ij M (x) xi V_j (Le 2014 eq 1.26), or the mean
   * with that of the bonds' other ends (eq 3.1) where there are several phases, and the strain of
   * the nonlocal deformation gradient F (eq 1.25). With full kinematics Cauchy's stress, sum t_ij M
   * (x) Y V_j/det F, and Green's strain, (F^T F - I)/2. With correspondence those that the law
   * knows. Collective.
   *
   * @param tau c theta/q at u, with up-to-date ghosts
   */
  template <int dim>
  NodalTensors<dim> nodal_tensors(const SolidBonds<dim> &bonds, const Vector &u, const Vector &tau);


  /** The stresses of such tensors of the owned nodes, with those out of the plane. */
  template <int dim>
  std::vector<dealii::SymmetricTensor<2, 3>> nodal_stresses(const SolidBonds<dim>     &bonds,
                                                            const BodyParameters<dim> &body,
                                                            const NodalTensors<dim>   &tensors);


  /** NodeQuantity::stresses and tensions at u, with ghosts. Collective. */
  template <int dim>
  std::vector<Vector> nodal_stress_components(const SolidBonds<dim>     &bonds,
                                              const BodyParameters<dim> &body,
                                              const Vector              &u);
  template <int dim>
  std::vector<Vector> nodal_tensions(const SolidBonds<dim> &bonds, const Vector &u);
} // namespace PeriDeal
