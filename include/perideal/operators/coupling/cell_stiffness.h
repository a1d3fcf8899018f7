// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/quadrature_lib.h>

#include <perideal/laws/interface.h>
#include <perideal/mesh/cell_geometry.h>
#include <perideal/scene/crack_geometry.h>
#include <perideal/scene/expression.h>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <vector>

namespace PeriDeal
{
  /**
   * Part of its strength that a bond of an exchange has where the conductivities of temperatures
   * differ by that factor on its way: it fades, since iterations between fields and conductivities
   * would not end where bonds come and go at one factor.
   */
  inline double kept_at_contrast(const double factor)
  {
    constexpr double begin = 1.25;
    return factor <= begin ? 1. :
                             std::max(0., (largest_contrast - factor) / (largest_contrast - begin));
  }


  /** What the bonds of an exchange follow: the stiffness in the body, or the conductivity. */
  template <int dim>
  struct CellStiffness
  {
    static constexpr unsigned int n_corners = dealii::GeometryInfo<dim>::vertices_per_cell;
    using CornerValues                      = std::array<double, n_corners>;

    std::function<double(const dealii::Point<dim> &, const double)> at;      // place, temperature
    bool                                                            uniform; // the same everywhere
    const Expression *start; // temperatures at first; null where the stiffness depends on none
    std::vector<CrackGeometry<dim>> cracks; // that may have another material on each side

    bool depends_on_temperature() const
    {
      return start != nullptr;
    }

    double at_first(const dealii::Point<dim> &p) const
    {
      return at(p, depends_on_temperature() ? start->value(p) : 0.);
    }

    struct Range
    {
      double lowest = std::numeric_limits<double>::max(), highest = 0.;
    };

    /**
     * The smallest and the largest at the Gauss points of a cell, and where a crack parts its
     * corners also just inside of these: materials that meet at the crack between Gauss points and
     * a side of the cell are two in it. Where there are two constant ones the largest is infinite,
     * so that no bond passes, however close they are.
     * @param temperatures of the corners; null: those at first
     */
    Range range(const CellCorners<dim> &corners, const CornerValues *const temperatures) const;
  };


  template <int dim>
  typename CellStiffness<dim>::Range CellStiffness<dim>::range(
    const CellCorners<dim>   &corners,
    const CornerValues *const temperatures) const
  {
    static const std::vector<CornerValues> shapes = [] {
      std::vector<CornerValues> list;
      const dealii::QGauss<dim> points(2);
      for (const dealii::Point<dim> &q : points.get_points())
        list.push_back(shape_values(q));
      for (unsigned int v = 0; v < n_corners; ++v)
        {
          const auto corner = dealii::GeometryInfo<dim>::unit_cell_vertex(v);
          list.push_back(shape_values(
            dealii::Point<dim>(corner + 1e-8 * (points.point(n_corners - 1 - v) - corner))));
        }
      return list;
    }();
    double reach = 0.;
    for (unsigned int v = 1; v < n_corners; ++v)
      reach = std::max(reach, corners[0].distance(corners[v]));
    const bool parted = std::any_of(cracks.begin(), cracks.end(), [&](const auto &crack) {
      bool parts = false;
      if (crack.is_near(corners[0], reach))
        for (unsigned int a = 0; a < n_corners; ++a)
          for (unsigned int b = 0; b < a; ++b)
            parts = parts || crack.separates(corners[a], corners[b]);
      return parts;
    });
    std::vector<double> found((parted ? 2 : 1) * n_corners);
    for (unsigned int q = 0; q < found.size(); ++q)
      {
        const CornerValues &shape = shapes[q];
        dealii::Point<dim>  p;
        double              T = 0.;
        for (unsigned int v = 0; v < n_corners; ++v)
          {
            p += shape[v] * corners[v];
            if (temperatures != nullptr)
              T += shape[v] * (*temperatures)[v];
          }
        found[q] = temperatures != nullptr ? at(p, T) : at_first(p);
      }
    const double lowest  = *std::min_element(found.begin(), found.end()),
                 highest = *std::max_element(found.begin(), found.end());
    Range range{lowest, highest};
    if (parted && lowest < highest && std::all_of(found.begin(), found.end(), [&](const double k) {
          return k == lowest || k == highest;
        }))
      range.highest = std::numeric_limits<double>::infinity();
    return range;
  }
} // namespace PeriDeal
