// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/study/stability.h>

#include <string>
#include <vector>

#include "stability_map.h"
#include "stability_scene.h"

namespace PeriDeal
{
  /** A random point, and on which side of the bound it was chosen. */
  struct RandomPoint
  {
    bool           inside = true;
    StabilityPoint point;

    /** It is as the bound says. */
    bool confirms() const
    {
      return inside == point.healthy();
    }
  };


  /** What has become of a map. */
  struct StabilityResult
  {
    std::string                 name, predicted, observed, bound; // the last three for readers
    std::string                 obstacle;                         // why there are no points
    std::vector<StabilityPoint> points;
    std::vector<RandomPoint>    random;
    std::vector<std::string>    left_out;
    double                      wall_time = 0.;

    /** How many random points of a side there are, and how many are as the bound says. */
    std::pair<unsigned int, unsigned int> confirmed(const bool inside) const;
  };

  /**
   * `map,` then the parameters of all maps, `sample` (grid, inside or outside) the first of them,
   * and `predicted,observed,verdict`.
   */
  std::string stability_csv(const std::vector<StabilityResult> &results);

  std::string stability_json(const std::string                  &scene,
                             const StabilityFacts               &facts,
                             const StabilityOptions             &options,
                             const std::vector<StabilityResult> &results);

  /** What the reader is told when a map is done. */
  std::vector<std::string> describe(const StabilityResult &result);
} // namespace PeriDeal
