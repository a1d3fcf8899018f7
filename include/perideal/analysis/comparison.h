// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/dofs/dof_handler.h>

#include <perideal/base/types.h>

#include <functional>

namespace PeriDeal
{
  /** Relative L2 norm and largest absolute value of a difference. */
  struct Difference
  {
    double relative_l2 = 0., maximum = 0.;
  };

  /**
   * Finite element values at the support points of another scalar element on the same mesh
   * (vertices or cell centres): the interpolant. u must have up-to-date ghosts; @p values is a
   * vector of the other dofs (owned entries are set). Not collective.
   */
  template <int dim>
  void interpolate_to(const dealii::DoFHandler<dim> &fem_dofs,
                      const Vector                  &u,
                      const dealii::DoFHandler<dim> &other_dofs,
                      Vector                        &values);

  /**
   * Nodal difference of two vectors of one layout, weighted by nodal volumes, relative to the
   * second. Collective.
   */
  Difference nodal_difference(const Vector                              &a,
                              const Vector                              &b,
                              const std::function<double(unsigned int)> &volume);

  /**
   * Finite element solution against a function: quadrature of order degree + 3 per cell, maximum at
   * the quadrature points. Collective.
   */
  template <int dim>
  Difference element_difference(const dealii::DoFHandler<dim>                           &dofs,
                                const Vector                                            &u,
                                const std::function<double(const dealii::Point<dim> &)> &exact);
} // namespace PeriDeal
