// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/tensor.h>
#include <deal.II/base/types.h>

#include <perideal/mesh/cell_geometry.h>

#include <memory>
#include <vector>

namespace PeriDeal
{
  /**
   * A cell as paths see it. Cells are neighbours if they have the nodes of a face in common: not
   * across a crack cut into the mesh.
   */
  template <int dim>
  struct PathCell
  {
    CellCorners<dim> corners;
    std::array<dealii::types::global_dof_index, dealii::GeometryInfo<dim>::vertices_per_cell> nodes;
  };


  /** Where a path starts or ends: at a vertex of cells. */
  template <int dim>
  struct PathEnd
  {
    dealii::types::global_dof_index node;
    dealii::Point<dim> position, crack_point; // the latter a little within its own cells (Nodes)
  };


  /**
   * What a path has in a cell: the change of the shape functions along the piece, over the square
   * root of its share of the path, times that of one over the number of cells around it.
   */
  template <int dim>
  struct PathPiece
  {
    unsigned int                                                     cell;
    std::array<double, dealii::GeometryInfo<dim>::vertices_per_cell> change;
  };


  /**
   * Follows straight lines from vertex to vertex through the cells on their way.
   *
   * A path that passes from cell to cell through the inside of faces walks so: where it crosses a
   * face the two coordinates of the face give the shape functions of both cells. So do paths within
   * a side of the body that is flat to 1e-4 of a cell, and those that are one edge of a cell. All
   * others (within faces of the inside, close to vertices, through hanging nodes, at cracks cut
   * into the mesh) are cut at all faces of the cells nearby, and for each piece the cells that hold
   * its middle are looked for.
   */
  template <int dim>
  class CellPaths
  {
  public:
    using End   = PathEnd<dim>;
    using Piece = PathPiece<dim>;

    /**
     * Paths connect nodes of a list that are no farther apart than the reach. Only cells near to
     * some of these are looked at; all cells must live on.
     * @param regular there are neither hanging nodes nor cracks cut into the mesh: then an edge has
     *                only those cells around it that have its nodes.
     */
    CellPaths(const std::vector<PathCell<dim>>      &cells,
              const std::vector<dealii::Point<dim>> &ends,
              const double                           reach,
              const bool                             regular);
    ~CellPaths();

    /**
     * @p pieces is overwritten; they are in the order of the way. Returns false if the path leaves
     * the body. Fast if paths from the same start follow in turn.
     */
    bool follow(const End &a, const End &b, std::vector<Piece> &pieces);

    /** The same for any path, without walking. */
    bool follow_plainly(const End &a, const End &b, std::vector<Piece> &pieces);

    /** Paths that could not be walked. */
    std::size_t n_followed_plainly() const
    {
      return n_plain;
    }

    std::size_t memory_consumption() const;

  private:
    static constexpr unsigned int n_corners      = dealii::GeometryInfo<dim>::vertices_per_cell;
    static constexpr unsigned int n_faces        = dealii::GeometryInfo<dim>::faces_per_cell;
    static constexpr unsigned int n_face_corners = n_corners / 2;

    /**
     * A cell at the start of a path, and the inverse of its Jacobian there: directions into the
     * cell have positive components.
     */
    struct Start
    {
      unsigned int           cell, corner;
      dealii::Tensor<2, dim> inverse;
    };

    /** Where a path leaves a cell: values of the shape functions of the corners of the face. */
    struct Exit
    {
      double                             place;
      unsigned int                       face;
      std::array<double, n_face_corners> weights;
    };

    enum class Step
    {
      leaves, // through the inside of a face
      stays,
      unclear
    };

    struct Tree;
    struct Line;

    std::vector<unsigned int> cells_near(const std::vector<dealii::Point<dim>> &ends,
                                         const double                           reach) const;
    void                      connect(const std::vector<unsigned int> &near);
    void                      start_at(const End &a);
    const Start *start_into(const dealii::Tensor<1, dim> &along, unsigned int &outer) const;
    bool         follow_edge(const End &b, std::vector<Piece> &pieces) const;
    bool         walk(const End &a, const End &b, std::vector<Piece> &pieces) const;
    unsigned int outer_beyond(const unsigned int cell,
                              const unsigned int outer,
                              const unsigned int exit) const;
    Step         leave(const unsigned int cell,
                       const unsigned int entry,
                       const unsigned int outer,
                       const Line        &line,
                       const double       from,
                       Exit              &exit) const;

    const std::vector<PathCell<dim>> &cells;
    const bool                        regular;
    std::unique_ptr<Tree>             tree;
    std::vector<unsigned int>         numbers; // in the tables, by cell
    std::vector<unsigned int>         beyond;  // each face: cell * n_faces + its face
    std::vector<std::pair<dealii::types::global_dof_index, unsigned int>>
                                    at_node; // cell * n_corners + corner, sorted
    std::vector<Start>              starts;
    dealii::types::global_dof_index start   = dealii::numbers::invalid_dof_index;
    std::size_t                     n_plain = 0;
    std::vector<unsigned int>       found; // memory of follow_plainly()
    std::vector<double>             places, cuts;
  };
} // namespace PeriDeal
