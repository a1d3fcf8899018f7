// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/exceptions.h>

#include <perideal/base/instantiate.h>
#include <perideal/laws/gauss_rule.h>
#include <perideal/laws/kernel.h>
#include <perideal/laws/volume_fraction.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace PeriDeal
{
  double linear_fraction(const double r, const double delta, const double h)
  {
    const double f = (delta + 0.5 * h - r) / h;
    if (f < 1e-9)
      return 0.;
    return f > 1. - 1e-9 ? 1. : f;
  }


  double plain_fraction(const double r, const double delta)
  {
    return r <= delta * (1. + 1e-9) ? 1. : 0.;
  }


  double shifted_distance(const double r, const double delta, const double h)
  {
    const double f = linear_fraction(r, delta, h);
    return r <= delta ? r - 0.5 * (1. - f) * h : delta - 0.5 * f * h;
  }


  namespace
  {
    /** Area of the disc of radius R within [0,a] x [0,b]; odd in a and in b. */
    double corner_area(const double a, const double b, const double R)
    {
      const double sign = (a < 0.) == (b < 0.) ? 1. : -1.;
      const double x = std::min(std::abs(a), R), y = std::min(std::abs(b), R);
      if (x * x + y * y <= R * R)
        return sign * x * y;
      // Under y up to where the circle comes down to it, then under the circle.
      const double x0      = std::sqrt((R - y) * (R + y));
      const auto   segment = [R](const double s) {
        return 0.5 * (s * std::sqrt((R - s) * (R + s)) + R * R * std::asin(s / R));
      };
      return sign * (x0 * y + segment(x) - segment(x0));
    }


    double disc_area(const double (&x)[2], const double (&y)[2], const double R)
    {
      return corner_area(x[1], y[1], R) - corner_area(x[0], y[1], R) - corner_area(x[1], y[0], R) +
             corner_area(x[0], y[0], R);
    }


    /**
     * Heights z in (low, high) where the slice circle of the ball touches an edge or a corner of
     * the rectangle, with both ends.
     */
    std::vector<double> kinks(const double (&x)[2],
                              const double (&y)[2],
                              const double low,
                              const double high,
                              const double delta)
    {
      std::vector<double> heights{low, high};
      const auto          add = [&](const double radius) {
        if (radius >= delta)
          return;
        const double z = std::sqrt((delta - radius) * (delta + radius));
        for (const double height : {-z, z})
          if (height > low && height < high)
            heights.push_back(height);
      };
      for (const double a : x)
        add(std::abs(a));
      for (const double b : y)
        add(std::abs(b));
      for (const double a : x)
        for (const double b : y)
          add(std::hypot(a, b));
      std::sort(heights.begin(), heights.end());
      return heights;
    }


    /**
     * Adaptive Gauss quadrature of a slice area. The substitution z = a + (b-a) u^2 (3 - 2u) turns
     * the half-integer powers at both ends, where the circle begins to touch, into whole ones.
     */
    template <typename Function>
    double integrate(const Function    &area,
                     const double       a,
                     const double       b,
                     const double       tolerance,
                     const unsigned int depth = 0)
    {
      static const GaussRule coarse(12), fine(20);
      const auto             smooth = [&](const double u) {
        return area(a + (b - a) * u * u * (3. - 2. * u)) * (b - a) * 6. * u * (1. - u);
      };
      const double first  = coarse.integrate(0., 1., smooth),
                   second = fine.integrate(0., 1., smooth);
      if (std::abs(first - second) <= tolerance || depth == 20)
        return second;
      const double middle = 0.5 * (a + b);
      return integrate(area, a, middle, tolerance, depth + 1) +
             integrate(area, middle, b, tolerance, depth + 1);
    }
  } // namespace


  template <int dim>
  double exact_fraction(const std::array<double, dim> &center,
                        const std::array<double, dim> &edges,
                        const double                   delta)
  {
    double nearest = 0., farthest = 0., volume = 1., ends[3][2] = {{0., 0.}, {0., 0.}, {0., 0.}};
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double c = std::abs(center[d]);
        ends[d][0]     = c - 0.5 * edges[d];
        ends[d][1]     = c + 0.5 * edges[d];
        nearest += std::pow(std::max(0., ends[d][0]), 2);
        farthest += ends[d][1] * ends[d][1];
        volume *= edges[d];
      }
    if (farthest <= delta * delta)
      return 1.;
    if (nearest >= delta * delta)
      return 0.;
    double inside = 0.;
    if (dim == 1)
      inside = std::min(ends[0][1], delta) - std::max(ends[0][0], -delta);
    else if (dim == 2)
      inside = disc_area(ends[0], ends[1], delta);
    else
      {
        const double low = std::max(ends[2][0], -delta), high = std::min(ends[2][1], delta);
        const auto   heights = kinks(ends[0], ends[1], low, high, delta);
        const auto   area    = [&](const double z) {
          return disc_area(ends[0], ends[1], std::sqrt(std::max(0., (delta - z) * (delta + z))));
        };
        for (unsigned int i = 0; i + 1 < heights.size(); ++i)
          if (heights[i + 1] > heights[i])
            inside += integrate(area, heights[i], heights[i + 1], 1e-13 * volume);
      }
    const double f = inside / volume;
    return f < 1e-13 ? 0. : std::min(f, 1.);
  }


  template <int dim>
  double weighted_shape(const KernelShape              shape,
                        const VolumeFraction           fraction,
                        const std::array<double, dim> &center,
                        const std::array<double, dim> &edges,
                        const double                   delta)
  {
    double square = 0.;
    for (const double x : center)
      square += x * x;
    const double r = std::sqrt(square);
    switch (fraction)
      {
        case VolumeFraction::none:
          return plain_fraction(r, delta) * kernel_shape(shape, r, delta);
        case VolumeFraction::exact:
          return exact_fraction<dim>(center, edges, delta) * kernel_shape(shape, r, delta);
        case VolumeFraction::linear:
          {
            const double h = *std::min_element(edges.begin(), edges.end());
            const double f = linear_fraction(r, delta, h);
            if (f == 0.)
              return 0.;
            const double at = shape == KernelShape::conical ? shifted_distance(r, delta, h) : r;
            return f * kernel_shape(shape, at, delta);
          }
      }
    Assert(false, dealii::ExcInternalError());
    return 0.;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(exact_fraction);
  PERIDEAL_INSTANTIATE_FUNCTION(weighted_shape);
} // namespace PeriDeal
