// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/tensor.h>

#include <perideal/scene/choices.h>

#include <array>
#include <vector>

namespace PeriDeal
{
  /** A neighbour in the family of a lattice node. */
  template <int dim>
  struct FamilyMember
  {
    std::array<int, dim> offset; /**< in lattice steps, never all zero */
    double               r;      /**< distance */
    double weight; /**< k(r)/r^n times volume fraction, for unit conductivity, without any volume */
  };


  /**
   * The whole family of a lattice node far from the body's surface, without the node itself. The
   * bond (i,j) conducts kappa w V_i V_j; so rho c dT_i/dt = sum_j kappa w_ij V_j (T_j - T_i).
   *
   * Sorted by offset, the first coordinate fastest; members of no weight are dropped. Weights of
   * mirrored offsets, and on cubic lattices those of permuted ones, are the same to the last bit.
   *
   * With Calibration::discrete the weights are scaled such that sum_j w V xi_a^2 = 2 in every
   * direction a, V the product of the spacings: by one factor on a cubic lattice, else by sum_a s_a
   * xi_a^2/r^2 with s from a dim x dim system.
   *
   * With Calibration::isotropic by sum_{a<=b} s_ab n_a^2 n_b^2, n = xi/r, such that
   *
   *   sum_j w V r^2 n_a n_b n_c n_d = 2/(dim + 2) (d_ab d_cd + d_ac d_bd + d_ad d_bc)
   *
   * (of which the former is the trace): all that a solid under a uniform strain knows of a family
   * (laws/family_moments.h) is then the same in all directions. On a cubic lattice the factor is
   * s_0 + s_1 sum_a n_a^4.
   *
   * @param spacing of the lattice in each direction; the smallest is the h of the linear fraction
   * @param n       exponent of the bond length, 0, 1 or 2
   *
   * Throws UserError if a direction has no neighbours or a factor is not positive: the horizon is
   * too small for the spacing.
   */
  template <int dim>
  std::vector<FamilyMember<dim>> lattice_family(const dealii::Tensor<1, dim> &spacing,
                                                const double                  delta,
                                                const KernelShape             shape,
                                                const unsigned int            n,
                                                const VolumeFraction          fraction,
                                                const Calibration             calibration);

  /**
   * What `Self term = paper` adds to the bonds with the touching neighbours, to be multiplied by
   * the volume of the node itself (not the neighbour's): 0.5 k(r/2)/r^n for the eight touching
   * neighbours in 2D (Bobaru 2012; with n = 2 its Table 1 comes out), 0.5 k(h)/h^n for the two in
   * 1D (Bobaru 2010, section 3, as printed) with k(0) instead for the conical kernel (as printed
   * that one does not converge). The neighbour's volume fraction does not enter. k has the
   * prefactor and the calibration of lattice_family(), for unit conductivity; the addition itself
   * is not calibrated away: it inflates the conductivity, by 8 % at m = 6.5.
   *
   * Throws UserError in 3D, where no paper defines it.
   */
  template <int dim>
  std::vector<FamilyMember<dim>> self_term_family(const dealii::Tensor<1, dim> &spacing,
                                                  const double                  delta,
                                                  const KernelShape             shape,
                                                  const unsigned int            n,
                                                  const VolumeFraction          fraction,
                                                  const Calibration             calibration);

  /**
   * sum_j w V xi_a^2 / 2 for each direction a: the conductivity, relative to the intended one, with
   * which a lattice conducts a linear field along its axes. 1 with discrete calibration.
   */
  template <int dim>
  std::array<double, dim> effective_conductivity(const std::vector<FamilyMember<dim>> &family,
                                                 const dealii::Tensor<1, dim>         &spacing);
} // namespace PeriDeal
