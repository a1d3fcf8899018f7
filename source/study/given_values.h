// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/scene.h>

#include "given_body.h"

namespace PeriDeal
{
  /**
   * Whether two sides that meet have other values where they meet, by more than 1/1000 of
   * all that is given on sides: near such a corner or edge no mesh has the solution, and errors get
   * smaller only as cells do. Values that change with time are looked at four times. Not
   * collective.
   */
  template <int dim>
  bool given_values_disagree(const Scene<dim> &scene, const SidePoints<dim> &sides);

  /**
   * How many cells along the longest edge a diffusion layer needs that grows from the sides of a
   * body: it is 2 sqrt(D t) wide at the first time of the output, with D the smallest diffusivity
   * of some places. 1 for steady states and elasticity, and where the first field is what is given
   * on all sides that have a condition. Not collective.
   */
  template <int dim>
  double fineness_of_first_layer(const Scene<dim> &scene, const SidePoints<dim> &sides);
} // namespace PeriDeal
