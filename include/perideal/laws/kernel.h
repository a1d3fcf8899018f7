// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/choices.h>

namespace PeriDeal
{
  /**
   * Dependence of a bond's micro-conductivity on its length r, without the prefactor and without
   * the 1/r^n: constant 1; conical (triangular in 1D) 1 - r/delta, zero from delta on; gaussian
   * exp(-(2 r/delta)^2).
   *
   * The constant and the gaussian shape are not cut at the horizon here: the volume fraction cuts
   * them, so that a cell whose centre is just outside counts with the part of it that is inside.
   */
  double kernel_shape(const KernelShape shape, const double r, const double delta);

  /**
   * Prefactor k0 of the micro-conductivity k(r) = k0 shape(r) for unit thickness (2D) or cross
   * section (1D), such that
   *
   *     integral over the ball of radius delta of  k(r)/r^n xi_x^2 dV = 2 kappa,
   *
   * which is to say that a linear field conducts kappa times its gradient. With M the integral over
   * s in [0,1] of shape(s delta) s^(dim+1-n), k0 = 2 kappa/(c delta^(dim+2-n) M), c = 2, pi, 4
   * pi/3. In 1D with n = 2 these are Bobaru 2010, eqs 16 and 17.
   *
   * @param dim   1, 2 or 3
   * @param n     exponent of the bond length, 0, 1 or 2
   * @param kappa conductivity; the result is proportional to it
   */
  double micro_conductivity(const unsigned int dim,
                            const KernelShape  shape,
                            const unsigned int n,
                            const double       delta,
                            const double       kappa = 1.);
} // namespace PeriDeal
