// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/point.h>

#include <perideal/scene/expression.h>
#include <perideal/scene/section.h>

#include <array>
#include <string>

namespace PeriDeal
{
  /** The body: a box of equal cells, such a box with a hole, or a mesh from a file. */
  enum class Shape
  {
    box,
    plate_with_hole,
    mesh_file
  };

  /** A square hole has the radius as half its edge and is turned by the hole angle. */
  enum class HoleShape
  {
    circle,
    square
  };

  /**
   * Where the peridynamic nodes sit: on mesh vertices (FE_Q(1) dofs) or at cell centres (FE_DGQ(0)
   * dofs).
   */
  enum class NodePlacement
  {
    vertices,
    cell_centers
  };

  /** Section `Domain`: the body, its mesh and the placement of the nodes. */
  template <int dim>
  class Domain : public SceneSection
  {
  public:
    Domain();

    Shape                         shape = Shape::box;
    dealii::Point<dim>            lower, upper;
    std::array<unsigned int, dim> cells;
    NodePlacement                 nodes = NodePlacement::vertices;
    dealii::Point<dim>            hole_center;
    double                        hole_radius = 0.25;
    HoleShape                     hole_shape  = HoleShape::circle;
    double                        hole_angle  = 0.; // degrees
    std::string                   mesh_file;
    unsigned int coarsening = 0; // times that cells are merged away from where they stay fine
    Expression   fine;           // they stay fine where greater than 0
    bool         fine_by_formula = false; // else in the zone of section `Coupling`


    /** Box and plate with a hole: edge length of a lattice cell in each direction. */
    dealii::Tensor<1, dim> spacing() const;

    /**
     * For programs that bring a mesh of any shape of their own: `Shape` becomes `mesh file` and no
     * file is asked for. Sides are the boundary ids of that mesh, and `Horizon` in section
     * `Peridynamics` has to be a length. A program whose mesh is a lattice gives its corners and
     * `Cells` instead: families of a lattice are the same everywhere, which makes operators fast.
     */
    void use_own_mesh();

    /**
     * Called once all entries are read: turns texts into the values above and checks them. Throws
     * UserError.
     */
    void parse();

    /**
     * Whether a point lies in the box between the corners, its boundary included (relative slack
     * 1e-9).
     */
    bool contains(const dealii::Point<dim> &p) const;

    /** Plate with a hole: whether the point lies in the hole. A cell whose centre does so does not exist. */
    bool in_hole(const dealii::Point<dim> &p) const;

  private:
    /** Cells or Node spacing. */
    void parse_cells();
    void require_countable(const std::string &entry) const;

    void parse_fine_part();

    void parse_hole();

    bool own_mesh = false;
  };
} // namespace PeriDeal
