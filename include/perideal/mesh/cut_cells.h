// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/crack_geometry.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace PeriDeal
{
  /**
   * Whether some crack separates two vertices of a cell. @tparam Cell an accessor or iterator of
   * deal.II
   */
  template <int dim, typename Cell>
  bool is_cut(const Cell &cell, const std::vector<CrackGeometry<dim>> &cracks)
  {
    for (const CrackGeometry<dim> &crack : cracks)
      if (crack.is_near(cell->center(), cell->diameter()))
        for (const unsigned int a : cell->vertex_indices())
          for (unsigned int b = 0; b < a; ++b)
            if (crack.separates(cell->vertex(a), cell->vertex(b)))
              return true;
    return false;
  }

  /** Whether a point near a cell lies beyond one of its faces that is a side of the body. */
  template <int dim, typename Cell>
  bool leaves_body(const Cell &cell, const dealii::Point<dim> &p)
  {
    const double same = 1e-6 * cell->diameter();
    for (const unsigned int f : cell->face_indices())
      if (const auto face = cell->face(f); face->at_boundary())
        {
          dealii::Tensor<1, dim> normal;
          if constexpr (dim == 1)
            normal[0] = 1.;
          else if constexpr (dim == 2)
            normal = dealii::cross_product_2d(face->vertex(1) - face->vertex(0));
          else
            normal = dealii::cross_product_3d(face->vertex(3) - face->vertex(0),
                                              face->vertex(2) - face->vertex(1));
          normal /= normal.norm();
          const dealii::Point<dim> on = face->center();
          if (((p - on) * normal) * ((cell->center() - on) * normal) < 0. &&
              std::abs((p - on) * normal) > same)
            return true;
        }
    return false;
  }


  /**
   * Whether a point of a cell on the line or plane of a crack lies on it, and the crack goes on
   * from there in all directions, so that this is no tip. @param to_sides or to the side of the
   * body
   */
  template <int dim, typename Cell>
  bool passes_through(const CrackGeometry<dim> &crack,
                      const Cell               &cell,
                      const dealii::Point<dim> &p,
                      const bool                to_sides)
  {
    constexpr double part = 1e-3;
    if (!crack.covers(p))
      return false;
    for (unsigned int d = 0; d < dim; ++d)
      {
        dealii::Tensor<1, dim> along;
        along[d] = 1.;
        along -= (along * crack.normal()) * crack.normal();
        if (along.norm() < 1e-6)
          continue;
        along *= part * cell->diameter() / along.norm();
        for (const double sign : {-1., 1.})
          if (const dealii::Point<dim> q = p + sign * along;
              !crack.covers(q) && !crack.is_closed_near(q) && !(to_sides && leaves_body(cell, q)))
            return false;
      }
    return true;
  }


  /**
   * Whether a cell carries nothing when cut cells are removed: a crack holds the middle of what its
   * line or plane cuts out of the cell. So a tip counts from the middle of a cell on, and a tip at
   * the edge of a cell leaves that cell whole. Of two cells on both sides of a crack that passes
   * through their common face, vertex (3D: or edge) the one on the right goes: a vertex that both
   * kept would hold the sides of the crack together. A cell that a crack touches with its tip only
   * stays. Pieces that meet have no tip there.
   *
   * @param cracks from make_open_geometries()
   * @param mouths the same where a crack begins at a vertex on the side of the body: there are
   *               bonds to the left of it that hold the vertex, which else only this cell has
   */
  template <int dim, typename Cell>
  bool is_removed(const Cell                            &cell,
                  const std::vector<CrackGeometry<dim>> &cracks,
                  const bool                             mouths = false)
  {
    const double same = 1e-6 * cell->diameter();
    for (const CrackGeometry<dim> &crack : cracks)
      {
        if (!crack.is_near(cell->center(), cell->diameter()))
          continue;
        // Where the edges of the cell cross the line or plane of the crack.
        std::vector<dealii::Point<dim>> section;
        for (unsigned int v = 0; v < cell->n_vertices(); ++v)
          for (unsigned int d = 0; d < dim; ++d)
            {
              const unsigned int w = v | (1u << d);
              if (w == v)
                continue;
              const double at_v = crack.signed_distance(cell->vertex(v)),
                           at_w = crack.signed_distance(cell->vertex(w));
              if ((at_v > 0.) == (at_w > 0.))
                continue;
              const dealii::Point<dim> p =
                cell->vertex(v) + at_v / (at_v - at_w) * (cell->vertex(w) - cell->vertex(v));
              if (std::none_of(section.begin(), section.end(), [&](const auto &q) {
                    return q.distance(p) <= same;
                  }))
                section.push_back(p);
            }
        if (section.empty())
          continue;
        dealii::Point<dim> middle;
        for (const dealii::Point<dim> &p : section)
          middle += (p - dealii::Point<dim>()) / static_cast<double>(section.size());
        if (section.size() < dim)
          {
            if (passes_through(crack, cell, middle, mouths))
              return true;
            continue;
          }
        if (crack.covers(middle) || (crack.is_closed_near(middle) && is_cut<dim>(cell, {crack})))
          return true;
      }
    return false;
  }


  /**
   * What is left of the stiffness of a cell in 2D where cracks remove cells in part at their tips:
   * the product over the cracks of (1 - p)/(1 + 2 p), p = clamp(s/w + 1/2, 0, 1), where the middle
   * of what the crack's line cuts out of the cell lies a distance s behind the tip and w is the
   * cell's width along the crack. The cell bears more than 1 - p of its force with 1 - p of its
   * stiffness; with this law the crack is as good as longer by p cells (doc/coupling.md). 0 where a
   * crack goes on, meets another one or ends on a side, as is_removed() has it.
   *
   * @param cracks from make_crack_geometries(), whose tips are not closed
   */
  template <int dim, typename Cell>
  double kept_of_cell(const Cell &cell, const std::vector<CrackGeometry<dim>> &cracks)
  {
    const double same = 1e-6 * cell->diameter();
    double       kept = 1.;
    for (const CrackGeometry<dim> &crack : cracks)
      {
        if (!crack.is_near(cell->center(), cell->diameter()))
          continue;
        const dealii::Point<dim>    &start = crack.corners()[0];
        const dealii::Tensor<1, dim> way   = crack.corners()[1] - start;
        // Of the section, in parts of the crack.
        double low = std::numeric_limits<double>::max(), high = -low;
        for (unsigned int v = 0; v < cell->n_vertices(); ++v)
          for (unsigned int d = 0; d < dim; ++d)
            {
              const unsigned int w    = v | (1u << d);
              const double       at_v = crack.signed_distance(cell->vertex(v)),
                           at_w       = crack.signed_distance(cell->vertex(w));
              if (w == v || (at_v > 0.) == (at_w > 0.))
                continue;
              const dealii::Point<dim> p =
                cell->vertex(v) + at_v / (at_v - at_w) * (cell->vertex(w) - cell->vertex(v));
              low  = std::min(low, (p - start) * way / way.norm_square());
              high = std::max(high, (p - start) * way / way.norm_square());
            }
        const double length = way.norm(), middle = 0.5 * (low + high);
        const bool   whole = low >= high || (high - low) * length <= same ||
                           crack.is_closed_near(start + middle * way);
        double most = 0.; // cells per length of the crack
        for (unsigned int d = 0; d < dim; ++d)
          most = std::max(most, std::abs(way[d]) / length / cell->extent_in_direction(d));
        const double part =
          whole ? (is_removed<dim>(cell, {crack}) ? 1. : 0.) :
                  std::clamp(std::min(middle, 1. - middle) * length * most + 0.5, 0., 1.);
        kept *= (1. - part) / (1. + 2. * part);
      }
    return kept;
  }
} // namespace PeriDeal
