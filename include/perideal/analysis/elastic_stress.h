// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/symmetric_tensor.h>

#include <perideal/scene/body_parameters.h>

namespace PeriDeal
{
  /**
   * The stress in three dimensions: with that out of the plane in plane strain, and zeros in plane
   * stress and in a bar.
   *
   * @param temperature_change at the point
   */
  template <int dim>
  dealii::SymmetricTensor<2, 3> full_stress(const dealii::SymmetricTensor<2, dim> &stress,
                                            const BodyParameters<dim>             &body,
                                            const dealii::Point<dim>              &p,
                                            const double temperature_change);

  /**
   * The same of a strain, by Hooke's law with the material of a point; thermal strain is taken off.
   */
  template <int dim>
  dealii::SymmetricTensor<2, 3> stress_of_strain(const dealii::SymmetricTensor<2, dim> &strain,
                                                 const BodyParameters<dim>             &body,
                                                 const dealii::Point<dim>              &p,
                                                 const double temperature_change);

  /** 2 G times the three-dimensional deviator of a strain, in 2D of plane strain. */
  template <int dim>
  dealii::SymmetricTensor<2, 3> shear_stress(const dealii::SymmetricTensor<2, dim> &strain,
                                             const BodyParameters<dim>             &body,
                                             const dealii::Point<dim>              &p);
} // namespace PeriDeal
