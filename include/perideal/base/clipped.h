// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/point.h>

#include <vector>

namespace PeriDeal
{
  /** The part of a segment or polygon in the half space normal * (x - origin) <= 0. */
  template <int dim>
  std::vector<dealii::Point<dim>> clipped(const std::vector<dealii::Point<dim>> &corners,
                                          const dealii::Point<dim>              &origin,
                                          const dealii::Tensor<1, dim>          &normal)
  {
    std::vector<dealii::Point<dim>> inside;
    for (std::size_t i = 0; i < corners.size(); ++i)
      {
        const dealii::Point<dim> &a = corners[i], &b = corners[(i + 1) % corners.size()];
        const double              at_a = normal * (a - origin), at_b = normal * (b - origin);
        if (at_a <= 0.)
          inside.push_back(a);
        if ((at_a < 0. && at_b > 0.) || (at_a > 0. && at_b < 0.))
          inside.push_back(a + at_a / (at_a - at_b) * (b - a));
      }
    return inside;
  }


  /** The part between two corners of a box along the axes. */
  template <int dim>
  std::vector<dealii::Point<dim>> clipped_to_box(std::vector<dealii::Point<dim>> corners,
                                                 const dealii::Point<dim>       &lower,
                                                 const dealii::Point<dim>       &upper)
  {
    for (unsigned int d = 0; d < dim; ++d)
      {
        const dealii::Tensor<1, dim> axis = dealii::Point<dim>::unit_vector(d);
        corners                           = clipped(clipped(corners, upper, axis), lower, -axis);
      }
    return corners;
  }
} // namespace PeriDeal
