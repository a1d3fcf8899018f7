// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "given_values.h"

#include <perideal/base/instantiate.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    constexpr double parts_of_time[] = {0., 0.31, 0.67, 1.};

    /** Values of one component that are given on one side of a box. */
    struct GivenOnSide
    {
      unsigned int      side, component;
      const Expression *value;
    };


    template <int dim>
    std::vector<GivenOnSide> given_on_sides(const Scene<dim> &scene)
    {
      std::vector<GivenOnSide>       list;
      const BoundaryConditions<dim> &given = scene.boundary_conditions;
      for (const SideCondition &condition : given.dirichlet)
        if (condition.id < 2 * dim)
          list.push_back({condition.id, 0, &condition.value});
      for (const VectorCondition &condition : given.displacement)
        for (unsigned int c = 0; c < condition.values.size() && condition.id < 2 * dim; ++c)
          if (condition.values[c] && (condition.held.empty() || !condition.held[c]))
            list.push_back({condition.id, c, &*condition.values[c]});
      return list;
    }


    /** A point of the box by its coordinates between 0 and 1. */
    template <int dim>
    Point<dim> place(const Scene<dim> &scene, const Point<dim> &unit)
    {
      Point<dim> p;
      for (unsigned int d = 0; d < dim; ++d)
        p[d] = (1. - unit[d]) * scene.domain.lower[d] + unit[d] * scene.domain.upper[d];
      return p;
    }


    /** Some points of a side, in coordinates between 0 and 1. */
    template <int dim>
    std::vector<Point<dim>> points_of_side(const unsigned int side)
    {
      constexpr unsigned int  n = 5;
      std::vector<Point<dim>> points;
      for (unsigned int k = 0, end = static_cast<unsigned int>(std::pow(n, dim - 1)); k < end; ++k)
        {
          Point<dim>   p;
          unsigned int rest = k;
          for (unsigned int d = 0; d < dim; ++d)
            if (d == side / 2)
              p[d] = side % 2;
            else
              {
                p[d] = static_cast<double>(rest % n) / (n - 1);
                rest /= n;
              }
          points.push_back(p);
        }
      return points;
    }
  } // namespace


  template <int dim>
  bool given_values_disagree(const Scene<dim> &scene)
  {
    constexpr double               small = 1e-3;
    const DeferredFormulaErrors    ignored; // they are told where the values are used
    const std::vector<GivenOnSide> all   = given_on_sides(scene);
    double                         least = std::numeric_limits<double>::max(), most = -least;
    double                         worst = 0.;
    for (const double part : parts_of_time)
      for (const GivenOnSide &one : all)
        for (const Point<dim> &unit : points_of_side<dim>(one.side))
          {
            const Point<dim> p = place(scene, unit);
            const double     t = part * scene.time.end_time, value = one.value->value(p, t);
            least = std::min(least, value);
            most  = std::max(most, value);
            for (const GivenOnSide &other : all)
              if (other.component == one.component && other.side / 2 != one.side / 2 &&
                  unit[other.side / 2] == other.side % 2)
                worst = std::max(worst, std::abs(value - other.value->value(p, t)));
          }
    return worst > 0. && worst > small * (most - least); // without any: no range
  }


  namespace
  {
    /** Something else than the first field acts on some side. */
    template <int dim>
    bool sides_disturb(const Scene<dim> &scene)
    {
      constexpr double        small   = 1e-3;
      const InitialAndSource &in_body = scene.initial_and_source;
      if (!scene.boundary_conditions.parts.empty())
        return true;
      for (const SurfaceTransfer &transfer : scene.boundary_conditions.transfers)
        if (!transfer.insulates())
          return true;
      for (const GivenOnSide &given : given_on_sides(scene))
        {
          double least = std::numeric_limits<double>::max(), most = -least, worst = 0.;
          for (const Point<dim> &unit : points_of_side<dim>(given.side))
            {
              const Point<dim> p     = place(scene, unit);
              const double     first = in_body.initial_value.value(p, 0.);
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
  double fineness_of_first_layer(const Scene<dim> &scene)
  {
    constexpr double most = dim == 1 ? 4096. : dim == 2 ? 256. : 32.; // as many are looked at
    constexpr double fine = 4.;                                       // cells across the layer
    if (scene.time.steady || scene.deforms || !scene.material.stores)
      return 1.;
    const DeferredFormulaErrors ignored;
    if (!sides_disturb(scene))
      return 1.;
    double longest = 0., diffusivity = std::numeric_limits<double>::max();
    for (unsigned int d = 0; d < dim; ++d)
      longest = std::max(longest, scene.domain.upper[d] - scene.domain.lower[d]);
    for (unsigned int side = 0; side < 2 * dim; ++side)
      for (const Point<dim> &unit : points_of_side<dim>(side))
        {
          const Point<dim> p       = place(scene, unit);
          const double     storage = scene.material.storage(p);
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
