// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/point.h>

#include <utility>
#include <vector>

namespace PeriDeal
{
  /** A straight piece of a crack: a segment in 2D (two corners), a planar polygon in 3D. */
  template <int dim>
  struct CrackPiece
  {
    std::vector<dealii::Point<dim>> corners;
    unsigned int                    crack; // from 0, in the order of the scene
    // Ends (2D) or edges (3D, from each corner to the next) on the body's surface; empty: none.
    std::vector<bool> closed;
  };


  /**
   * How an end of a crack (2D) or a corner of one (3D) moves: at rest until the first time of its
   * path, straight and with constant speed from point to point, and on with the last velocity after
   * the last time.
   */
  template <int dim>
  struct CrackTip
  {
    unsigned int                                       crack, corner;
    std::vector<std::pair<double, dealii::Point<dim>>> path; // times in ascending order
    dealii::Tensor<1, dim>                             last_velocity;
    bool by_path; // from the entry `Paths`, else `Growth`

    dealii::Point<dim> at(const double t) const;

    /** Speed right after time t. */
    double speed(const double t) const;
  };


  /**
   * The pieces of all cracks at time t, the whole path of each tip included. In 2D a crack is
   * followed from its first end to its second, so that all of its pieces have the same left side;
   * pieces in one line are one. Pieces without length are left out.
   *
   * @param corners of each crack before it grows
   */
  template <int dim>
  std::vector<CrackPiece<dim>> crack_pieces(
    const std::vector<std::vector<dealii::Point<dim>>> &corners,
    const std::vector<CrackTip<dim>>                   &tips,
    const double                                        t);
} // namespace PeriDeal
