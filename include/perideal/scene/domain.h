// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/point.h>

#include <perideal/scene/expression.h>
#include <perideal/scene/holes.h>
#include <perideal/scene/phase_map.h>
#include <perideal/scene/section.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * The body: a box of equal cells, such a box with a hole, a mesh from a file, the pixels of an
   * image, or a mesh of deal.II's generators.
   */
  enum class Shape
  {
    box,
    plate_with_hole,
    mesh_file,
    image,
    generator
  };

  /** What happens to parts of an image that no side holds. */
  enum class IslandRule
  {
    error,
    remove,
    pin
  };

  /**
   * A component of the displacement that is held at 0 to keep an island where it is: at a mesh
   * vertex, or at a cell centre for nodes there.
   */
  template <int dim>
  struct Pin
  {
    dealii::Point<dim> position;
    unsigned int       component;
    bool               at_center;
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

    Shape                         shape;
    dealii::Point<dim>            lower, upper; // with the extra layers, as cells
    std::array<unsigned int, dim> cells;
    NodePlacement                 nodes = NodePlacement::vertices;
    Holes<dim>                    holes; // of a plate with holes

    /** Cells are merged, so many times, away from where they stay fine. */
    struct Coarsening
    {
      unsigned int times;
      Expression   fine;               // they stay fine where it is greater than 0
      bool         by_formula = false; // else, unless at ends or corners, in the zone of `Coupling`
      bool         at_ends    = false; // at the ends of cracks, in 3D their edges
      bool         at_corners = false; // at those of the body, too, that its mesh has
      unsigned int refinements = 0;    // how often cells that are no lattice's are halved before
    };
    Coarsening coarsening;

    /**
     * Rows of cells beyond each side (left, right, bottom, ...), which are in no result, and the
     * body between them.
     */
    struct ExtraLayers
    {
      std::array<unsigned int, 2 * dim> layers{};
      dealii::Point<dim>                body_lower, body_upper;
    };
    ExtraLayers extra;

    std::shared_ptr<PhaseMap> image; // of `Shape = image`, else null
    std::vector<std::string>  notes; // on the image and the cracks, for the user

    /** Parts of an image that nothing joins to the rest. */
    struct Islands
    {
      IslandRule            rule;
      bool                  cells_are_given = false; // by the body whose heat this is
      std::vector<Pin<dim>> pins;                    // set by Scene
    };
    Islands islands;

    /** Files are looked for here, too, and read by the processes of this communicator together. */
    struct Files
    {
      std::string mesh, image;
      std::string generator, arguments; // of deal.II, in place of a mesh file
      bool        own_mesh = false;     // of a program, which asks for no file
      std::string folder;
      MPI_Comm    communicator = MPI_COMM_SELF;
    };
    Files files;

    /** Nodes and cells lie on a lattice, not on a mesh with places of its own. */
    bool has_lattice() const
    {
      return shape != Shape::mesh_file && shape != Shape::generator && !holes.fitted();
    }

    /** The mesh, where there is no lattice, for messages. */
    std::string mesh_text() const;

    bool is_box() const
    {
      return shape == Shape::box;
    }

    bool is_image() const
    {
      return shape == Shape::image;
    }

    bool has_nodes_at_centers() const
    {
      return nodes == NodePlacement::cell_centers;
    }

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
     * Whether a point lies in the box of the body, without extra layers, its boundary included
     * (relative slack 1e-9).
     */
    bool contains(const dealii::Point<dim> &p) const;

    /**
     * Whether a cell of the lattice with this centre exists: not in a hole, nor an empty one of an
     * image.
     */
    bool has_cell_at(const dealii::Point<dim> &center) const;

    /** Whether cells of the lattice are missing. */
    bool has_voids() const;

    bool has_extra_layers() const;

    /**
     * Whether what is at a point of the mesh belongs to the results: anywhere but in extra layers.
     */
    bool shows(const dealii::Point<dim> &p) const
    {
      return !has_extra_layers() || contains(p);
    }

    /** The image without extra layers. */
    PhaseMap image_of_body() const;

  private:
    /** Cells or Node spacing. */
    void parse_cells();
    void require_countable(const std::string &entry) const;

    void declare_mesh();
    void parse_fine_part();
    void parse_mesh();

    void parse_hole();
    void parse_listed_holes();

    void parse_extra_layers();

    unsigned int count(const std::string &entry) const;
    void         parse_image();
  };
} // namespace PeriDeal
