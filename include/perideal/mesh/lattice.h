// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/point.h>

#include <array>
#include <cmath>

namespace PeriDeal
{
  /**
   * The regular lattice on which the nodes of a box or of a plate with a hole lie. Sites are
   * numbered per direction from 0; a site may carry no node (hole).
   */
  template <int dim>
  struct Lattice
  {
    using Index = std::array<int, dim>;

    dealii::Point<dim>     lower, upper; // corners of the body
    dealii::Tensor<1, dim> spacing;
    Index                  n_sites;
    bool                   at_centers = false; // sites at cell centres, else at cell vertices

    /**
     * Position of a site; the same on every process and exact at the body's corners. Sites outside
     * the body are allowed.
     */
    dealii::Point<dim> position(const Index &index) const
    {
      dealii::Point<dim> p;
      for (unsigned int d = 0; d < dim; ++d)
        {
          const int    n_cells = at_centers ? n_sites[d] : n_sites[d] - 1;
          const double s       = (at_centers ? index[d] + 0.5 : index[d]) / n_cells;
          p[d]                 = lower[d] * (1. - s) + upper[d] * s;
        }
      return p;
    }

    /** The site nearest to a position. */
    Index index(const dealii::Point<dim> &p) const
    {
      Index i;
      for (unsigned int d = 0; d < dim; ++d)
        i[d] =
          static_cast<int>(std::lround((p[d] - lower[d]) / spacing[d] - (at_centers ? 0.5 : 0.)));
      return i;
    }

    /** Volume of one cell of the lattice. */
    double cell_volume() const
    {
      double v = 1.;
      for (unsigned int d = 0; d < dim; ++d)
        v *= spacing[d];
      return v;
    }
  };
} // namespace PeriDeal
