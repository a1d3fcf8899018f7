// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <optional>

#include "attempts.h"

namespace PeriDeal
{
  /**
   * The same mesh with cubic elements, where the error of quadratic ones in a goal J, a value at a
   * probe, a flow or a stress intensity, is J(u_3) - J(u_2): what dual weights with a dual solution
   * in cubic elements would give. Nothing for other elements, for fields, for transient
   * problems, for a horizon that is a length, and in 3D for elastic bodies, where a third mesh
   * costs less. Not collective.
   */
  template <int dim>
  std::optional<Attempt> cubic_attempt(const Scene<dim> &scene, const Attempt &attempt);

  /**
   * By what to multiply that difference. At ends of cracks, and for flows at corners of two sides
   * with values, cubic elements have half of the error of quadratic ones.
   */
  template <int dim>
  double factor_of_cubic(const Scene<dim> &scene);

  /** In time and memory, of that of quadratic ones on the same mesh. */
  template <int dim>
  constexpr double cost_of_cubic()
  {
    return dim == 3 ? 8. : 4.;
  }
} // namespace PeriDeal
