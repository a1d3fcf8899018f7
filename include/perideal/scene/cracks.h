// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/point.h>

#include <perideal/scene/section.h>

#include <string>
#include <vector>

namespace PeriDeal
{
  /** What FEM and the mesh do with a crack (entry `Mesh` of section `Cracks`). */
  enum class CrackMesh
  {
    pairs,
    faces,
    removed
  };

  /**
   * Section `Cracks`: segments in 2D (two points each), planar polygons in 3D (three or more
   * corners each).
   */
  template <int dim>
  class Cracks : public SceneSection
  {
  public:
    Cracks();

    std::vector<std::vector<dealii::Point<dim>>> cracks;
    CrackMesh                                    mesh                = CrackMesh::pairs;
    double                                       transmission        = 0.;
    double                                       contact_conductance = -1.; // negative: not given

    /**
     * Throws UserError: wrong points, no length or area, not planar, cracks of another dimension,
     * contradicting entries.
     */
    void parse();

    /** Throws UserError naming the first crack that lies completely outside a box. */
    void check_inside(const dealii::Point<dim> &lower, const dealii::Point<dim> &upper) const;

  private:
    void parse_segments();

    void parse_polygons();
  };
} // namespace PeriDeal
