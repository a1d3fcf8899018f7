// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/point.h>
#include <deal.II/grid/tria.h>

#include <perideal/scene/boundary_conditions.h>

#include <array>
#include <map>
#include <vector>

namespace PeriDeal
{
  /**
   * Points of a face with the area (length, 1) that each stands for, in the coordinates of the cell
   * and of the body.
   */
  template <int dim>
  struct FacePoints
  {
    std::vector<dealii::Point<dim>> unit, real;
    std::vector<double>             area;
  };

  /** Holes::rim_over_faces() of faces on holes; 1 on other faces. */
  template <int dim>
  class RimFactors
  {
  public:
    /** @param mesh with the holes; no cell that touches one may be refined */
    RimFactors(const Holes<dim> &holes, const dealii::Triangulation<dim> &mesh);

    template <typename Face>
    double operator()(const Face &face) const
    {
      const auto found = of_face.empty() ? of_face.end() :
                                           of_face.find(static_cast<int>(face->index()));
      return found == of_face.end() ? 1. : found->second;
    }

  private:
    std::map<int, double> of_face;
  };

  template <int dim>
  using CellVertices = std::array<dealii::Point<dim>, dealii::GeometryInfo<dim>::vertices_per_cell>;

  /**
   * Gauss points on what of a face lies in a part of a side.
   *
   * Where the formula of the part changes along a face of two dimensions is found by bisection:
   * lengths are exact to round-off if no piece is shorter than 1/16 of the face. In three
   * dimensions this is done on 32 lines across the face: areas under a smooth rim are good to about
   * 1e-3 of the faces that it cuts, and pieces narrower than 1/8 of a face may be overlooked.
   *
   * @param vertices of the cell, which is mapped (bi-, tri-)linearly
   * @param n_points Gauss points along each direction of a face or piece
   */
  template <int dim>
  FacePoints<dim> points_in_part(const CellVertices<dim> &vertices,
                                 const unsigned int       face,
                                 const Part              &part,
                                 const unsigned int       n_points);
} // namespace PeriDeal
