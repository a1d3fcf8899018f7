// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "roughness.h"

#include <perideal/base/instantiate.h>
#include <perideal/scene/expression.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    constexpr double no_limit = 100.;


    template <int dim>
    double modulus_at(const Scene<dim> &scene, const Point<dim> &p)
    {
      return scene.deforms ? scene.moduli(p).shear : scene.material.conductivity.value(p);
    }


    /**
     * The smallest exponent of r, at most 1, with which a solution may go around a corner of four
     * quadrants with these moduli: values and fluxes of a cos + b sin, passed on from quadrant to
     * quadrant, come back after a turn, so that the trace of what passes them on is 2.
     */
    double exponent_of(const std::array<double, 4> &moduli)
    {
      constexpr unsigned int n_steps = 400;
      const auto             excess  = [&](const double exponent) {
        const double c = std::cos(0.5 * numbers::PI * exponent),
                     s = std::sin(0.5 * numbers::PI * exponent);
        std::array<double, 4> turn{{1., 0., 0., 1.}};
        for (const double k : moduli)
          turn = {{c * turn[0] + s / k * turn[2],
                   c * turn[1] + s / k * turn[3],
                   c * turn[2] - k * s * turn[0],
                   c * turn[3] - k * s * turn[1]}};
        return turn[0] + turn[3] - 2.;
      };
      double low = 1. / n_steps;
      for (unsigned int k = 2; k <= n_steps; ++k)
        {
          double high = static_cast<double>(k) / n_steps;
          if (excess(low) < 0. && excess(high) >= 0.)
            {
              for (unsigned int halving = 0; halving < 30; ++halving)
                {
                  const double middle                = 0.5 * (low + high);
                  (excess(middle) < 0. ? low : high) = middle;
                }
              return high;
            }
          low = high;
        }
      return 1.;
    }


    /** Where the planes through p across axes a and b cross. */
    template <int dim>
    double exponent_at(const Scene<dim>  &scene,
                       const Point<dim>  &p,
                       const unsigned int a,
                       const unsigned int b)
    {
      constexpr double away     = 1e-6; // of the edges
      const auto       quadrant = [&](const double s, const double t) {
        Point<dim> q = p;
        q[a] += s * away * (scene.domain.upper[a] - scene.domain.lower[a]);
        q[b] += t * away * (scene.domain.upper[b] - scene.domain.lower[b]);
        return modulus_at(scene, q);
      };
      return exponent_of(
        {{quadrant(1., 1.), quadrant(-1., 1.), quadrant(-1., -1.), quadrant(1., -1.)}});
    }


    template <int dim>
    double lowest_exponent(const Scene<dim> &scene, const std::vector<std::vector<double>> &planes)
    {
      constexpr unsigned int n_along = dim == 3 ? 5 : 1;
      double                 lowest  = no_limit;
      for (unsigned int a = 0; a < dim; ++a)
        for (unsigned int b = a + 1; b < dim; ++b)
          for (const double at_a : planes[a])
            for (const double at_b : planes[b])
              for (unsigned int k = 0; k < n_along; ++k)
                {
                  Point<dim> p;
                  for (unsigned int d = 0; d < dim; ++d)
                    p[d] = scene.domain.lower[d] +
                           (k + 0.4653) / n_along * (scene.domain.upper[d] - scene.domain.lower[d]);
                  p[a]           = at_a;
                  p[b]           = at_b;
                  const double e = exponent_at(scene, p, a, b);
                  if (e < 1. - 1e-2)
                    lowest = std::min(lowest, e);
                }
      return lowest;
    }


    template <int dim>
    bool any_end_on_plane(const Scene<dim>                       &scene,
                          const CrackedBox                       &box,
                          const std::vector<std::vector<double>> &planes)
    {
      constexpr double near = 1e-6; // of the edge
      for (const auto &crack : box.cracks)
        for (const auto &corner : crack)
          for (unsigned int d = 0; d < dim; ++d)
            for (const double place : planes[d])
              {
                const double edge = scene.domain.upper[d] - scene.domain.lower[d];
                Point<dim>   p;
                for (unsigned int c = 0; c < dim; ++c)
                  p[c] = corner[c];
                Point<dim> behind = p, ahead = p;
                behind[d] -= 10. * near * edge;
                ahead[d] += 10. * near * edge;
                if (std::abs(corner[d] - place) < near * edge &&
                    modulus_at(scene, behind) != modulus_at(scene, ahead))
                  return true;
              }
      return false;
    }


    /** Forces act at once on a body that is at rest. */
    template <int dim>
    bool starts_suddenly(const Scene<dim> &scene)
    {
      if (!scene.deforms || scene.elasticity.is_static())
        return false;
      const Point<dim> middle =
        scene.domain.lower + 0.5 * (scene.domain.upper - scene.domain.lower);
      for (const VectorCondition &load : scene.boundary_conditions.traction)
        for (const auto &value : load.values)
          if (value && value->value(middle, 0.) != 0.)
            return true;
      for (const VectorCondition &side : scene.boundary_conditions.displacement)
        for (const auto &value : side.values)
          if (side.rate && value && value->value(middle, 0.) != 0.)
            return true;
      return false;
    }
  } // namespace


  template <int dim>
  double order_of_rough_places(const Scene<dim>                                      &scene,
                               const CrackedBox                                      &box,
                               const std::optional<std::vector<std::vector<double>>> &planes)
  {
    const DeferredFormulaErrors ignored; // they are told where the values are used
    double                      order = no_limit;
    if (planes)
      {
        order = std::min(order, 2. * lowest_exponent(scene, *planes));
        if (any_end_on_plane(scene, box, *planes))
          order = std::min(order, 1.);
      }
    if (starts_suddenly(scene))
      order = std::min(order, 1.);
    return order;
  }


#define PERIDEAL_TEMPLATES(dim)                             \
  template double order_of_rough_places(const Scene<dim> &, \
                                        const CrackedBox &, \
                                        const std::optional<std::vector<std::vector<double>>> &);
  PERIDEAL_FOR_EACH_DIM(PERIDEAL_TEMPLATES)
#undef PERIDEAL_TEMPLATES
} // namespace PeriDeal
