// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <perideal/scene/scene.h>

namespace PeriDeal
{
  /*
   * Near-tip fields of unit intensity (Westergaard, Irwin) in the frame of the end of a crack: x_1
   * ahead of it, x_2 across; r, angle the polar coordinates. Modes 0 and 1 are I and II.
   */

  /** Stresses in the plane. */
  dealii::SymmetricTensor<2, 2> near_stress(const unsigned int mode,
                                            const double       r,
                                            const double       angle);

  /**
   * du_i/dx_1.
   * @param kappa (3 - nu)/(1 + nu) in plane stress, 3 - 4 nu in plane strain
   */
  dealii::Tensor<1, 2> near_slope(const unsigned int mode,
                                  const double       r,
                                  const double       angle,
                                  const double       kappa,
                                  const double       shear);

  /** 1 at 0 and before, 0 at 1 and behind, without jumps of two derivatives; and its slope. */
  double smooth_step(const double s);
  double slope_of_smooth_step(const double s);

  /**
   * From a point to the nearest region or point that is held or loaded; regions are looked at in
   * the centres and corners of cells.
   */
  template <int dim>
  double distance_to_parts(const Scene<dim> &scene, const dealii::Point<dim> &p);
} // namespace PeriDeal
