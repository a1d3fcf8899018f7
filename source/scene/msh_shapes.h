// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

namespace PeriDeal
{
  /** A kind of cell, its corners numbered as Gmsh does. */
  struct MshShape
  {
    const char  *name;
    unsigned int dimension, n_corners, n_faces;
    /** The ends of the edges at each corner, in an order that is right-handed. */
    unsigned int neighbors[8][3];
    /**
     * Their numbers of corners, and those, seen from outside counter-clockwise (in 2D the body lies
     * to the left; in 1D its ends).
     */
    unsigned int n_of_face[6], faces[6][4];
  };

  /** Of cells that can be computed with or divided; a pyramid is none. */
  const MshShape &shape_of_cell(const unsigned int dimension, const unsigned int n_corners);
} // namespace PeriDeal
