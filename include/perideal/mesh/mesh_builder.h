// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/grid/tria.h>
#include <deal.II/grid/tria_description.h>

#include <perideal/scene/crack_geometry.h>
#include <perideal/scene/phases.h>
#include <perideal/scene/scene.h>

#include <mpi.h>

#include <memory>
#include <string>
#include <vector>

namespace PeriDeal
{
  /**
   * Boundary id of the two faces of a crack that is cut into the mesh. Always insulated. No mesh
   * file has it.
   */
  constexpr dealii::types::boundary_id crack_boundary_id =
    dealii::numbers::internal_face_boundary_id - 1;

  /**
   * The mesh of a scene, distributed over the processes (in 1D, and with more than 100000 coarse
   * cells, every process knows all cells). Boxes are few coarse cells refined globally where the
   * cell counts allow, because every process keeps the coarse mesh; `Cracks / Mesh = faces` keeps
   * the crack on coarse faces and doubles its vertices. With `Coarsening` the mesh is graded: as
   * fine as the lattice only where Grading says. Cells are dealt out to processes so that all have
   * the same work, bonds of a zone included. Boundary ids as in BoundaryConditions. Notes for the
   * user are appended to @p notes.
   *
   * Throws UserError: crack not on faces, mesh file unreadable, broken or of other cells than quads
   * and hexes. Collective.
   */
  template <int dim>
  std::unique_ptr<dealii::Triangulation<dim>> build_mesh(const Scene<dim>         &scene,
                                                         const MPI_Comm            communicator,
                                                         std::vector<std::string> &notes);

  /** Throws UserError if a process has no cells of a mesh. Collective. */
  template <int dim>
  void require_cells_everywhere(const dealii::Triangulation<dim> &mesh);


  /**
   * Let regions given as `mesh(id)` know the material ids of the mesh. Asked for a point, they look
   * through the coarse cells, which every process has all of. Keeps a reference to the mesh.
   *
   * Throws UserError for an id that no cell has. Not collective.
   */
  template <int dim>
  void set_material_ids(const dealii::Triangulation<dim> &mesh, const Regions &regions);


  /** The side of the box of a body on which the middle of a face lies, else `hole`. */
  template <int dim>
  dealii::types::boundary_id side_of_box(const Domain<dim>        &domain,
                                         const dealii::Point<dim> &center);


  /** A coarse mesh as plain lists. */
  template <int dim>
  struct CoarseMesh
  {
    std::vector<dealii::Point<dim>>    vertices;
    std::vector<dealii::CellData<dim>> cells;
  };

  /** Length (2D) or area (3D) of a crack that lies on interior faces of the mesh. */
  template <int dim>
  double measure_on_faces(const CoarseMesh<dim> &mesh, const CrackGeometry<dim> &crack);

  /**
   * Whether all of a crack that is inside the body lies on whole interior faces of the mesh: then
   * both cells beside each piece hold that piece, while a piece inside a cell is held by one cell
   * only. The crack may leave the body.
   */
  template <int dim>
  bool lies_on_faces(const CoarseMesh<dim> &mesh, const CrackGeometry<dim> &crack);

  /**
   * Cut cracks that lie on cell faces into a coarse mesh: around each vertex on a crack the cells
   * fall into groups connected through faces that are not on a crack; every group but the first
   * gets a vertex of its own. So crack tips stay closed, crossings and cracks that leave the body
   * open up.
   */
  template <int dim>
  void cut_along_faces(CoarseMesh<dim> &mesh, const std::vector<CrackGeometry<dim>> &cracks);
} // namespace PeriDeal
