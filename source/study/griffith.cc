// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "griffith.h"

#include <perideal/base/instantiate.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace PeriDeal
{
  namespace
  {
    double share(const double toughness, const double intensity)
    {
      return intensity > 0. ? toughness / intensity : std::numeric_limits<double>::infinity();
    }


    template <typename Load>
    double least(const std::vector<GriffithEnd> &ends, const Load &load)
    {
      double first = std::numeric_limits<double>::infinity();
      for (const GriffithEnd &end : ends)
        first = std::min(first, load(end));
      return first;
    }
  } // namespace


  double GriffithEnd::load() const
  {
    return mode_1 > 0. ? share(toughness, std::sqrt(kink().release())) : share(toughness, 0.);
  }


  double GriffithEnd::load_by_hoop_stress() const
  {
    return mode_1 > 0. ? share(toughness, kink_of_hoop_stress(mode_1, mode_2).mode_1) :
                         share(toughness, 0.);
  }


  double GriffithState::load() const
  {
    return least(ends, [](const GriffithEnd &end) { return end.load(); });
  }


  double GriffithState::load_by_hoop_stress() const
  {
    return least(ends, [](const GriffithEnd &end) { return end.load_by_hoop_stress(); });
  }


  double GriffithState::strength() const
  {
    return std::min(1., load()) * force;
  }


  double GriffithState::strength_by_hoop_stress() const
  {
    return std::min(1., load_by_hoop_stress()) * force;
  }


  std::pair<unsigned int, unsigned int> crack_and_end(const std::string &name)
  {
    unsigned int crack = 0, end = 0;
    std::sscanf(name.c_str(), "crack %u end %u", &crack, &end);
    return {crack - 1, end - 1};
  }


  template <int dim>
  GriffithState griffith_state(const Scene<dim>             &scene,
                               const Cracks<dim>            &cracks,
                               const nlohmann::ordered_json &model)
  {
    GriffithState state;
    if (model.contains("largest force"))
      state.force = std::abs(model["largest force"]["value"].template get<double>());
    if (!model.contains("stress intensity") || dim != 2)
      return state;
    for (const auto &[name, k] : model["stress intensity"].items())
      {
        const auto [crack, number]       = crack_and_end(name);
        const dealii::Point<dim> &tip    = cracks.cracks[crack][number];
        const Moduli              moduli = scene.moduli(tip);
        const double              nu     = moduli.poisson();
        const double              young =
          moduli.young() / (scene.elasticity.plane == PlaneState::stress ? 1. : 1. - nu * nu);
        GriffithEnd end;
        end.name      = name;
        end.mode_1    = k["I"].template get<double>();
        end.mode_2    = k["II"].template get<double>();
        end.toughness = std::sqrt(young * scene.material.fracture_energy->value(tip));
        state.ends.push_back(end);
      }
    return state;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(griffith_state);
} // namespace PeriDeal
