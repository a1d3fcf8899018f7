// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /** An element of a Gmsh file, and where it stands. */
  struct MshElement
  {
    int                         number = 0;
    unsigned int                line   = 0; // of the file, from 1
    unsigned int                n  = 0; // nodes: 1 of a point, 2 of a line, 4 of a quadrilateral, 8
    int                         id = 0; // physical, 0 without one
    std::array<unsigned int, 8> nodes{}; // in Gmsh's order, as indices of MshMesh::points
  };


  /** What PeriDeal uses of a Gmsh file: cells of the dimension, the elements of one less, which
   * name sides of the body or faces inside it, and points that are named. */
  struct MshMesh
  {
    std::vector<std::array<double, 3>> points;
    std::vector<int>                   numbers; // of the points in the file
    std::vector<MshElement>            cells, sides;
    std::vector<MshElement>            interfaces; // sides between two cells; by check_msh()
    std::vector<MshElement>            places;     // of dimension 0, in 2D and 3D
    std::map<std::pair<unsigned int, std::string>, int> ids; // of dimensions and physical names
  };


  /** Throw the UserError about a line of a mesh file. */
  [[noreturn]] void msh_error(const std::string &name,
                              const unsigned int line,
                              const std::string &what);

  /**
   * Read a Gmsh file of the versions 2 to 2.2, 4.0 and 4.1, as text; 2.2 and 4.1 also binary.
   * Comments between sections are passed over, groups of one dimension with one name are one, nodes
   * that are given twice at one place count once. Checked: header, order and ends of sections,
   * counts, whole and finite numbers, numbers of elements given once, entities and nodes that are
   * named exist, types of elements that a mesh of that dimension can have.
   *
   * @param name of the file, for messages. Throws UserError: one sentence with the line, what was
   * found and what is expected. Not collective.
   */
  MshMesh parse_msh(const std::string &text, const std::string &name, const unsigned int dim);

  /** A mesh as text, version 2.2, as deal.II reads it. Not collective. */
  std::string text_of_msh(const MshMesh &mesh, const unsigned int dim);

  /**
   * Whether the cells are a mesh. Each has a positive length, area or volume at each of its nodes
   * (or a negative one at each: then deal.II turns it around), none is there twice, each face
   * belongs to at most two, which lie on opposite sides of it; each side is a face of a cell and
   * has one id. Sides between two cells become interfaces. What has passed this can be ordered by
   * GridTools::consistently_order_cells(), which loops on folded cells.
   *
   * Throws UserError as parse_msh() does. Not collective.
   */
  void check_msh(MshMesh &mesh, const std::string &name, const unsigned int dim);

  /**
   * Read and check a file, which is looked for as it is named and in @p folder. Throws UserError as
   * the above do, and where there is no such file. Not collective.
   */
  MshMesh read_msh(const std::string &file_name, const std::string &folder, const unsigned int dim);
} // namespace PeriDeal
