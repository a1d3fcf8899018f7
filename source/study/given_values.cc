// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "given_values.h"

#include <perideal/base/instantiate.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <vector>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    constexpr double parts_of_time[] = {0., 0.31, 0.67, 1.};

    /** Values of one component that are given on one side. */
    struct GivenOnSide
    {
      types::boundary_id side;
      unsigned int       component;
      const Expression  *value;
    };


    template <int dim>
    std::vector<GivenOnSide> given_on_sides(const Scene<dim> &scene, const SidePoints<dim> &sides)
    {
      std::vector<GivenOnSide>       list;
      const BoundaryConditions<dim> &given = scene.boundary_conditions;
      for (const SideCondition &condition : given.dirichlet)
        if (sides.count(condition.id) > 0)
          list.push_back({condition.id, 0, &condition.value});
      for (const VectorCondition &condition : given.displacement)
        for (unsigned int c = 0; c < condition.values.size() && sides.count(condition.id) > 0; ++c)
          if (condition.values[c] && (condition.held.empty() || !condition.held[c]))
            list.push_back({condition.id, c, &*condition.values[c]});
      return list;
    }


    /** The conditions on each component at points where values are given. */
    template <int dim>
    std::map<std::vector<double>, std::vector<const GivenOnSide *>> conditions_at_points(
      const std::vector<GivenOnSide> &all,
      const SidePoints<dim>          &sides)
    {
      std::map<std::vector<double>, std::vector<const GivenOnSide *>> at;
      for (const GivenOnSide &one : all)
        for (const Point<dim> &p : sides.at(one.side))
          {
            std::vector<double> key(p.begin_raw(), p.end_raw());
            key.push_back(one.component);
            auto &conditions = at[key];
            if (conditions.empty() || conditions.back() != &one)
              conditions.push_back(&one);
          }
      return at;
    }
  } // namespace


  template <int dim>
  bool given_values_disagree(const Scene<dim> &scene, const SidePoints<dim> &sides)
  {
    constexpr double               small = 1e-3;
    const DeferredFormulaErrors    ignored; // they are told where the values are used
    const std::vector<GivenOnSide> all   = given_on_sides(scene, sides);
    double                         least = std::numeric_limits<double>::max(), most = -least;
    double                         worst = 0.;
    for (const auto &[key, conditions] : conditions_at_points(all, sides))
      for (const double part : parts_of_time)
        {
          const Point<dim> p = point_of<dim>(key.data());
          const double     t = part * scene.time.end_time,
                       first = conditions.front()->value->value(p, t);
          for (const GivenOnSide *const one : conditions)
            {
              const double value = one->value->value(p, t);
              least              = std::min(least, value);
              most               = std::max(most, value);
              worst              = std::max(worst, std::abs(value - first));
            }
        }
    return worst > 0. && worst > small * (most - least); // without any: no range
  }


  namespace
  {
    /** Something else than the first field acts on some side. */
    template <int dim>
    bool sides_disturb(const Scene<dim> &scene, const SidePoints<dim> &sides)
    {
      constexpr double        small   = 1e-3;
      const InitialAndSource &in_body = scene.initial_and_source;
      if (!scene.boundary_conditions.parts.empty())
        return true;
      for (const SurfaceTransfer &transfer : scene.boundary_conditions.transfers)
        if (!transfer.insulates())
          return true;
      for (const GivenOnSide &given : given_on_sides(scene, sides))
        {
          double least = std::numeric_limits<double>::max(), most = -least, worst = 0.;
          for (const Point<dim> &p : sides.at(given.side))
            {
              const double first = in_body.initial_value.value(p, 0.);
              for (const double part : parts_of_time)
                {
                  const double value = given.value->value(p, part * scene.time.end_time);
                  least              = std::min({least, value, first});
                  most               = std::max({most, value, first});
                  worst              = std::max(worst, std::abs(value - first));
                }
            }
          if (worst > small * std::max(std::abs(least), std::abs(most)))
            return true;
        }
      return false;
    }
  } // namespace


  template <int dim>
  double fineness_of_first_layer(const Scene<dim> &scene, const SidePoints<dim> &sides)
  {
    constexpr double most = dim == 1 ? 4096. : dim == 2 ? 256. : 32.; // as many are looked at
    constexpr double fine = 4.;                                       // cells across the layer
    if (scene.time.steady || scene.deforms || !scene.material.stores)
      return 1.;
    const DeferredFormulaErrors ignored;
    if (!sides_disturb(scene, sides))
      return 1.;
    double longest = 0., diffusivity = std::numeric_limits<double>::max();
    for (unsigned int d = 0; d < dim; ++d)
      longest = std::max(longest, scene.domain.upper[d] - scene.domain.lower[d]);
    for (const auto &[side, points] : sides)
      for (const Point<dim> &p : points)
        {
          const double storage = scene.material.storage(p);
          if (storage > 0.)
            diffusivity = std::min(diffusivity, scene.material.conductivity.value(p) / storage);
        }
    double first = scene.time.end_time;
    for (const double t : scene.output.write_times)
      if (t > 0.)
        first = std::min(first, t);
    const double width = 2. * std::sqrt(diffusivity * first);
    return width > 0. ? std::clamp(fine * longest / width, 1., most) : 1.;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(given_values_disagree);
  PERIDEAL_INSTANTIATE_FUNCTION(fineness_of_first_layer);
} // namespace PeriDeal
