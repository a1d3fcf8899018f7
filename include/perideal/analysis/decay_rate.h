// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/laws/lattice_family.h>

#include <array>
#include <vector>

namespace PeriDeal
{
  /** One bond of a lattice family, for decay rates; unused components of xi are zero. */
  struct LatticeTerm
  {
    std::array<double, 3> xi; /**< bond vector */
    double coefficient;       /**< kappa w V, so that rho c dT_i/dt = sum coefficient (T_j - T_i) */
  };

  /** The terms of a lattice family: coefficient = conductivity x weight x cell volume. */
  template <int dim>
  std::vector<LatticeTerm> lattice_terms(const std::vector<FamilyMember<dim>> &family,
                                         const dealii::Tensor<1, dim>         &spacing,
                                         const double                          conductivity);

  /**
   * Rate lambda at which a product of sines (or cosines) of the wave numbers k_a decays on a
   * lattice without surfaces: sum_j coefficient_j (1 - prod_a cos(k_a xi_a)) / storage. Exact for
   * the semi-discrete system with odd (sines) or even (cosines) continuation. Units 1/time.
   */
  double lattice_decay_rate(const std::vector<LatticeTerm> &terms,
                            const std::array<double, 3>    &wave_numbers,
                            const double                    storage);

  /**
   * The same for the continuous nonlocal operator: the integral over the ball of k(r)/r^n (1 -
   * prod_a cos(k_a xi_a)) dV / storage, k with the prefactor of micro_conductivity(). By the ball's
   * symmetry the product averages over directions to cos z, J_0(z), sin z/z in 1D, 2D, 3D with z =
   * |k| r; what is left is a smooth integral over r, taken to about 1e-13. The kernel is cut at
   * delta.
   */
  double nonlocal_decay_rate(const unsigned int           dim,
                             const KernelShape            shape,
                             const unsigned int           n,
                             const double                 delta,
                             const std::array<double, 3> &wave_numbers,
                             const double                 conductivity,
                             const double                 storage);

  /** kappa |k|^2 / storage: the limit of both for a horizon that goes to zero. */
  double classical_decay_rate(const std::array<double, 3> &wave_numbers,
                              const double                 conductivity,
                              const double                 storage);
} // namespace PeriDeal
