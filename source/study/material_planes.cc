// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "material_planes.h"

#include <perideal/base/instantiate.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    using Properties = std::vector<double>;

    /** All that makes the solution rough where it jumps. */
    template <int dim>
    Properties properties_at(const Scene<dim> &scene, const Point<dim> &p)
    {
      const Material &material = scene.material;
      Properties      found;
      if (scene.deforms)
        {
          const Moduli moduli = scene.moduli(p);
          const double T =
            scene.elasticity.reference_temperature + scene.elasticity.temperature_change.value(p);
          found = {moduli.bulk, moduli.shear, material.thermal_expansion.value(p, T)};
          if (!scene.elasticity.is_static())
            found.push_back(material.density.value(p));
          return found;
        }
      found.push_back(material.conductivity.value(p));
      if (!scene.time.steady && material.stores)
        found.push_back(material.storage(p));
      return found;
    }


    bool differ(const Properties &a, const Properties &b)
    {
      constexpr double least = 0.05; // of a change that a smooth material does not make so soon
      for (std::size_t k = 0; k < a.size(); ++k)
        if (std::abs(a[k] - b[k]) > least * std::max(std::abs(a[k]), std::abs(b[k])))
          return true;
      return false;
    }


    /** Where on a line, between 0 and 1, properties jump. */
    std::vector<double> jumps_along(const std::function<Properties(const double)> &properties)
    {
      constexpr unsigned int n = 1024;
      std::vector<double>    places;
      Properties             before = properties(0.5 / n);
      for (unsigned int k = 1; k < n; ++k)
        {
          const Properties after = properties((k + 0.5) / n);
          if (differ(before, after))
            {
              double     low = (k - 0.5) / n, high = (k + 0.5) / n;
              Properties left = before, right = after;
              for (unsigned int halving = 0; halving < 34 && differ(left, right); ++halving)
                {
                  const double     middle = 0.5 * (low + high);
                  const Properties here   = properties(middle);
                  if (differ(left, here))
                    {
                      high  = middle;
                      right = here;
                    }
                  else
                    {
                      low  = middle;
                      left = here;
                    }
                }
              if (differ(left, right)) // else it is steep, but smooth
                places.push_back(0.5 * (low + high));
            }
          before = after;
        }
      return places;
    }
  } // namespace


  template <int dim>
  std::optional<std::vector<std::vector<double>>> material_planes(const Scene<dim> &scene)
  {
    // Of an oblique interface each line shows another place.
    constexpr unsigned int n_across = dim == 3 ? 6 : 16, most = dim == 3 ? 5 : 12;
    constexpr double       same = 1e-8;
    if (scene.deforms ?
          scene.material.uniform_moduli() && scene.material.thermal_expansion.is_constant() :
          scene.material.uniform_conductivity() && scene.time.steady)
      return {};
    const DeferredFormulaErrors      ignored; // they are told where the values are used
    const Point<dim>                &lower = scene.domain.lower;
    const Tensor<1, dim>             edges = scene.domain.upper - lower;
    std::vector<std::vector<double>> planes(dim);
    unsigned int                     n_planes = 0;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const unsigned int n_lines = static_cast<unsigned int>(std::pow(n_across, dim - 1));
        for (unsigned int line = 0; line < n_lines; ++line)
          {
            const auto places = jumps_along([&](const double s) {
              Point<dim>   p;
              unsigned int rest = line;
              for (unsigned int c = 0; c < dim; ++c)
                {
                  double at = s;
                  if (c != d) // not in the middle, where symmetric bodies have their axes
                    {
                      at = (rest % n_across + 0.5347) / n_across;
                      rest /= n_across;
                    }
                  p[c] = lower[c] + at * edges[c];
                }
              return properties_at(scene, p);
            });
            for (const double s : places)
              {
                const double place = lower[d] + s * edges[d];
                if (std::none_of(planes[d].begin(), planes[d].end(), [&](const double other) {
                      return std::abs(other - place) < same * edges[d];
                    }))
                  {
                    planes[d].push_back(place);
                    ++n_planes;
                  }
                if (planes[d].size() > most)
                  return {};
              }
          }
        std::sort(planes[d].begin(), planes[d].end());
      }
    if (n_planes == 0)
      return {};
    return planes;
  }


#define PERIDEAL_TEMPLATES(dim) \
  template std::optional<std::vector<std::vector<double>>> material_planes(const Scene<dim> &);
  PERIDEAL_FOR_EACH_DIM(PERIDEAL_TEMPLATES)
#undef PERIDEAL_TEMPLATES
} // namespace PeriDeal
