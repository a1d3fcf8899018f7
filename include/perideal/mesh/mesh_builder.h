// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/grid/tria.h>

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
} // namespace PeriDeal
