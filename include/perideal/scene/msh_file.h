// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/base/user_error.h>

#include <array>
#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace PeriDeal
{
  /** An element of a mesh file, and where it stands. What it is follows from its dimension and its
   * corners: `msh_shape()`. */
  struct MshElement
  {
    int                         number = 0;
    unsigned int                line   = 0; // of the file, from 1
    unsigned int                n      = 0; // corners
    int                         id     = 0; // physical, 0 without one
    std::array<unsigned int, 8> nodes{};    // in Gmsh's order, as indices of MshMesh::points
  };


  /** What PeriDeal uses of a mesh file: cells of the dimension, the elements of one less, which
   * name sides of the body or faces inside it, and points that are named. */
  struct MshMesh
  {
    unsigned int                       dim = 0; // of the cells
    std::vector<std::array<double, 3>> points;
    std::vector<int>                   numbers; // of the points in the file; 0 of those it has not
    std::vector<MshElement>            cells, sides;
    std::vector<MshElement>            interfaces; // sides between two cells; by check_msh()
    std::vector<MshElement>            places;     // of dimension 0, in 2D and 3D
    std::map<std::pair<unsigned int, std::string>, int> ids; // of dimensions and physical names
    double                   surface = 0.;  // area (2D: length) of the surface; by check_msh()
    std::vector<std::string> notes;         // what was done to what the file has, for the user
    std::size_t              n_divided = 0; // cells of the file that were divided; else 0
    /** Nodes of the surface that lie on an edge or a node of cells which do not have them: the body
     * is apart there. */
    std::vector<unsigned int> touching;
  };


  /** How large and how good the cells of a mesh are. */
  struct MshQuality
  {
    using Place = std::array<double, 3>;

    Place  lower{}, upper{};                         // of all corners
    double smallest = 0., median = 0., largest = 0.; // lengths of edges
    double volume = 0.;                              // area in 2D, length in 1D
    /**
     * The least of all corners of cells: what unit vectors along the edges there span, 1 where they
     * are at right angles. Also of Gauss' points where that is not positive.
     */
    double      worst      = 1.;
    std::size_t worst_cell = 0; // its index
    Place       smallest_at{}, worst_at{};
  };

  /** There are no cells of the dimension. */
  struct NoCells : public UserError
  {
    using UserError::UserError;
  };

  /** Throw the UserError about a line of a mesh file. */
  [[noreturn]] void msh_error(const std::string &name,
                              const unsigned int line,
                              const std::string &what);

  /** "triangle": an element of so many corners. */
  const char *msh_shape(const unsigned int dimension, const unsigned int n_corners);

  /**
   * Read a Gmsh file of the versions 2 to 2.2, 4.0 and 4.1, as text or binary. Comments between
   * sections are passed over, groups of one dimension with one name are one, nodes that are given
   * twice at one place count once, elements of higher order are those of their corners. Checked:
   * header, order and ends of sections, counts, whole and finite numbers, numbers of elements given
   * once, entities and nodes that are named exist, elements that a mesh of that dimension can have.
   *
   * @param name of the file, for messages. Throws UserError: one sentence with the line, what was
   * found and what is expected. Not collective.
   */
  MshMesh parse_msh(const std::string &text, const std::string &name, const unsigned int dim);

  /** A mesh as text, version 2.2, with its names. Not collective. */
  std::string text_of_msh(const MshMesh &mesh, const unsigned int dim);

  /**
   * Whether the cells are a mesh. Each has a positive length, area or volume at each of its nodes
   * (or a negative one at each: then it is turned around), none is there twice, each face belongs
   * to at most two, which lie on opposite sides of it; each side is a face of a cell and has one
   * id. Sides between two cells become interfaces. What has passed this can be ordered by
   * GridTools::consistently_order_cells(), which loops on folded cells.
   *
   * Throws UserError as parse_msh() does. Not collective.
   */
  void check_msh(MshMesh &mesh, const std::string &name, const unsigned int dim);

  /**
   * Divide a mesh that has been checked and has triangles, tetrahedra or wedges, such that there
   * are quadrilaterals or hexahedra only: each edge, face and cell gets a vertex in its middle, so
   * that a triangle becomes 3, a quadrilateral and a tetrahedron 4, a hexahedron 8 cells. Edges
   * along which wedges are extruded stay whole where no triangle and no tetrahedron needs their
   * middle: a wedge becomes 3 cells then, else 6, and a hexahedron in such a layer 4. Sides and
   * interfaces are divided alike. Other meshes are left as they are. Not collective.
   */
  void divide_msh(MshMesh &mesh, const unsigned int dim);

  /** Of a mesh that is divided. Not collective. */
  MshQuality quality_of_msh(const MshMesh &mesh, const unsigned int dim);

  /**
   * Read a file, which is looked for as it is named and in @p folder, check and divide it, and take
   * notes on what that made of it. A file of another format than Gmsh's is converted by the Python
   * package before. The last file is kept: as long as it does not change, it is not read again.
   * Throws UserError as the above do, and where there is no such file. Not collective.
   *
   * @param dim 0: the highest that the file has cells of
   */
  std::shared_ptr<const MshMesh> read_msh(const std::string &file_name,
                                          const std::string &folder,
                                          const unsigned int dim);

  /**
   * What a mesh has, in lines: cells, size, spacing, sides, regions and points by their names, and
   * a horizon that fits. Not collective.
   */
  std::vector<std::string> describe_msh(const MshMesh &mesh, const std::string &name);
} // namespace PeriDeal
