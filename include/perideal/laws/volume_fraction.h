// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/choices.h>

#include <array>

namespace PeriDeal
{
  /**
   * Part of a neighbour's volume that counts, by its distance alone: clip((delta + h/2 - r)/h, 0,
   * 1) (Bobaru 2012, Algorithm 1), h the smallest spacing. Values within 1e-9 of 0 and of 1 are
   * taken as 0 and 1, so that a node at r = delta + h/2 up to rounding is always out.
   */
  double linear_fraction(const double r, const double delta, const double h);

  /**
   * One for r <= delta (1 + 1e-9), else zero. Families with delta = 3 h so contain the nodes at 3
   * h.
   */
  double plain_fraction(const double r, const double delta);

  /**
   * Distance at which Algorithm 1 of Bobaru 2012 evaluates the conical kernel: the middle of the
   * part of the cell that is inside. r for r < delta - h/2; r - (1-f) h/2 for r <= delta; delta - f
   * h/2 beyond, with f the linear fraction. Continuous in r.
   */
  double shifted_distance(const double r, const double delta, const double h);

  /**
   * Part of an axis-parallel interval, rectangle or box that lies within the ball of radius delta
   * about the origin.
   *
   * In 2D a closed form. In 3D the closed form on slices is integrated by adaptive Gauss quadrature
   * between the heights where the slice circle touches an edge or a corner, to about 1e-12 of the
   * cell. Mirrored centres give the same bits.
   *
   * @param center relative to the ball's centre
   * @param edges  full edge lengths, positive
   */
  template <int dim>
  double exact_fraction(const std::array<double, dim> &center,
                        const std::array<double, dim> &edges,
                        const double                   delta);

  /**
   * Kernel shape times volume fraction of a neighbour (no prefactor, no 1/r^n). The conical kernel
   * is evaluated at the shifted distance with the linear fraction; every other combination at the
   * distance itself.
   */
  template <int dim>
  double weighted_shape(const KernelShape              shape,
                        const VolumeFraction           fraction,
                        const std::array<double, dim> &center,
                        const std::array<double, dim> &edges,
                        const double                   delta);
} // namespace PeriDeal
