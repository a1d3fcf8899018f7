// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/simulation/simulation.h>

#include <array>
#include <vector>

#include "attempts.h"

namespace PeriDeal
{
  /**
   * Lattices on which bonds break, with ever more nodes in a horizon that is a length: elements
   * with a zone of bonds that follows what breaks, or bonds in the whole body where these cannot be
   * had.
   */
  template <int dim>
  class GrowthLattices
  {
  public:
    explicit GrowthLattices(const Scene<dim> &scene);

    /** The one with so many spacings in the horizon. Not collective. */
    Attempt at(const unsigned int m) const;

    /** Of a horizon, on an attempt. */
    double spacing(const unsigned int m) const
    {
      return 1. / m;
    }

    bool follows() const
    {
      return coupled;
    }

  private:
    Attempt attempt(const unsigned int m) const;

    /** So that cracks along the rows lie between two of them on all lattices alike. */
    unsigned int with_cracks_between_rows(const unsigned int direction, const unsigned int n) const;

    const Scene<dim> &scene;
    CrackedBox        box;
    bool              coupled = true;
  };


  /** Points in the middle between the nodes that a crack has parted. Collective. */
  template <int dim>
  std::vector<std::array<double, 3>> points_of_new_cracks(const Problem<dim> &problem);

  /** The farthest distance of a point of either crack to the other. */
  double distance_of_points(const std::vector<std::array<double, 3>> &one,
                            const std::vector<std::array<double, 3>> &other);
} // namespace PeriDeal
