// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "goal_estimate.h"

#include <perideal/base/instantiate.h>

namespace PeriDeal
{
  template <int dim>
  std::optional<Attempt> cubic_attempt(const Scene<dim> &scene, const Attempt &attempt)
  {
    const bool rests = scene.deforms ? scene.elasticity.is_static() : scene.time.steady;
    if (scene.accuracy.measure == AccuracyMeasure::field || !rests ||
        scene.peridynamics.horizon > 0. || (dim == 3 && scene.deforms))
      return {};
    Attempt cubic = attempt;
    for (Setting &setting : cubic.settings)
      if (setting.first == "Finite elements/Degree" && setting.second == "2")
        {
          setting.second = "3";
          return cubic;
        }
    return {};
  }


  template <int dim>
  double factor_of_cubic(const Scene<dim> &scene)
  {
    const bool halves = !scene.cracks.cracks.empty() ||
                        scene.accuracy.measure == AccuracyMeasure::flow;
    return halves ? 2. : 1.;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(cubic_attempt);
  PERIDEAL_INSTANTIATE_FUNCTION(factor_of_cubic);
} // namespace PeriDeal
