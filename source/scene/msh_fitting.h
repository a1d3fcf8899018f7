// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/msh_file.h>

#include <array>
#include <string>
#include <vector>

namespace PeriDeal
{
  /** A face of one cell alone: in 3D a triangle or a quadrilateral, in 2D an edge. */
  struct MshSurfaceFace
  {
    std::array<unsigned int, 4> nodes; // sorted; unused ones are -1
    unsigned int                cell;
  };

  /**
   * Whether faces of the surface that have their corners in common lie on each other without being
   * one face: a quadrilateral against triangles, or triangles against such along the other
   * diagonal. The body would be apart there, though no node says so. Then throw the UserError with
   * the place and the cells. A note is taken where more than two faces of the surface meet at an
   * edge (in 2D edges at a node): there the body hangs together by a line or a point. Not
   * collective.
   */
  void check_fit(MshMesh                           &mesh,
                 const std::vector<MshSurfaceFace> &surface,
                 const std::string                 &name,
                 const unsigned int                 dim);

  /**
   * Take a note if the cells are pieces that have no nodes in common: whatever lies beside each
   * other there is apart, also where curved faces of unlike meshes leave no node that touches. Not
   * collective.
   */
  void note_pieces(MshMesh &mesh, const unsigned int dim);
} // namespace PeriDeal
