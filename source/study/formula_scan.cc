// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "formula_scan.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** Cells of the finest raster that is looked at, along each edge of a body or its side. */
    template <int dim>
    unsigned int finest_raster(const bool on_side)
    {
      return dim == 1 ? 4096 : dim == 2 ? (on_side ? 1024 : 256) : (on_side ? 128 : 32);
    }


    /** Values of a function on a raster of an n-dimensional unit cube, the first axis fastest. */
    struct Raster
    {
      Raster(const unsigned int                           n,
             const unsigned int                           cells,
             const std::function<double(const double *)> &function)
        : n(n)
        , cells(cells)
      {
        std::size_t size = 1;
        for (unsigned int d = 0; d < n; ++d)
          size *= cells + 1;
        for (std::size_t k = 0; k < size; ++k)
          {
            double      x[3] = {0., 0., 0.};
            std::size_t rest = k;
            for (unsigned int d = 0; d < n; ++d, rest /= cells + 1)
              x[d] = static_cast<double>(rest % (cells + 1)) / cells;
            values.push_back(function(x));
          }
      }


      /** The multilinear interpolant from every stride-th point. */
      double interpolant(const std::size_t k, const unsigned int stride) const
      {
        std::size_t rest = k, base = 0, step = 1;
        double      fraction[3];
        std::size_t steps[3];
        for (unsigned int d = 0; d < n; ++d)
          {
            const std::size_t i = rest % (cells + 1);
            rest /= cells + 1;
            const std::size_t low = std::min<std::size_t>(i / stride * stride, cells - stride);
            fraction[d]           = static_cast<double>(i - low) / stride;
            base += low * step;
            steps[d] = stride * step;
            step *= cells + 1;
          }
        double sum = 0.;
        for (unsigned int v = 0; v < (1u << n); ++v)
          {
            double      weight = 1.;
            std::size_t at     = base;
            for (unsigned int d = 0; d < n; ++d)
              {
                weight *= (v >> d) & 1 ? fraction[d] : 1. - fraction[d];
                at += (v >> d) & 1 ? steps[d] : 0;
              }
            sum += weight > 0. ? weight * values[at] : 0.;
          }
        return sum;
      }


      unsigned int cells_needed() const
      {
        constexpr double allowed = 0.2;
        double           mean = 0., variation = 0.;
        for (const double v : values)
          mean += v / values.size();
        for (const double v : values)
          variation += (v - mean) * (v - mean);
        if (!(variation > 1e-24 * values.size() * (mean * mean + 1e-300)))
          return 1;
        for (unsigned int coarse = 1; coarse < cells; coarse *= 2)
          {
            double error = 0.;
            for (std::size_t k = 0; k < values.size(); ++k)
              error += std::pow(values[k] - interpolant(k, cells / coarse), 2);
            if (error < allowed * allowed * variation)
              return coarse;
          }
        return cells;
      }

      const unsigned int  n, cells;
      std::vector<double> values;
    };


    /** A formula in the body, and on a side of it if @p side is one. */
    template <int dim>
    double cells_of(const Scene<dim>                                &scene,
                    const std::function<double(const Point<dim> &)> &formula,
                    const unsigned int side = numbers::invalid_unsigned_int)
    {
      const bool         on_side = side < 2 * dim;
      const unsigned int n       = on_side ? dim - 1 : dim;
      if (n == 0)
        return 1.;
      const Raster raster(n, finest_raster<dim>(on_side), [&](const double *x) {
        Point<dim> p;
        for (unsigned int d = 0, k = 0; d < dim; ++d)
          {
            const double s = on_side && d == side / 2 ? side % 2 : x[k++];
            p[d]           = (1. - s) * scene.domain.lower[d] + s * scene.domain.upper[d];
          }
        return formula(p);
      });
      return raster.cells_needed();
    }
  } // namespace


  template <int dim>
  double fineness_of_formulas(const Scene<dim> &scene)
  {
    const DeferredFormulaErrors ignored; // they are told where the values are used
    double                      most = 1.;
    const auto                  see  = [&](const Expression &formula) {
      if (formula.depends_on_position())
        most = std::max(most, cells_of<dim>(scene, [&](const Point<dim> &p) {
                          return formula.value(p);
                        }));
    };
    see(scene.initial_and_source.source);
    if (!scene.time.steady)
      see(scene.initial_and_source.initial_value);
    for (const auto *const list : {&scene.initial_and_source.body_force,
                                   &scene.initial_and_source.initial_displacement,
                                   &scene.initial_and_source.initial_velocity})
      for (const Expression &formula : *list)
        see(formula);
    if (!scene.material.uniform_conductivity())
      most = std::max(most, cells_of<dim>(scene, [&](const Point<dim> &p) {
                        return scene.material.conductivity.value(p);
                      }));
    const auto on_side = [&](const unsigned int id, const Expression &formula) {
      if (id < 2 * dim && formula.depends_on_position())
        most = std::max(most,
                        cells_of<dim>(
                          scene,
                          [&](const Point<dim> &p) { return formula.value(p); },
                          id));
    };
    for (const SideCondition &given : scene.boundary_conditions.dirichlet)
      on_side(given.id, given.value);
    for (const auto *const list :
         {&scene.boundary_conditions.displacement, &scene.boundary_conditions.traction})
      for (const VectorCondition &given : *list)
        for (const auto &value : given.values)
          if (value)
            on_side(given.id, *value);
    return most;
  }


  template double fineness_of_formulas(const Scene<1> &);
  template double fineness_of_formulas(const Scene<2> &);
  template double fineness_of_formulas(const Scene<3> &);
} // namespace PeriDeal
