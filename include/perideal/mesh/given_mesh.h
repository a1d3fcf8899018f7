// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/grid/manifold.h>
#include <deal.II/grid/tria.h>

#include <perideal/mesh/mesh_builder.h>
#include <perideal/scene/domain.h>

#include <mpi.h>

#include <map>
#include <memory>
#include <utility>

namespace PeriDeal
{
  /** A coarse mesh that is no lattice: its cells, its sides, and what of it is round. */
  template <int dim>
  struct GivenMesh
  {
    /** By the number of the cell and of its face; cutting along cracks leaves both as they are. */
    using FaceKey = std::pair<unsigned int, unsigned int>;

    CoarseMesh<dim>                               coarse;
    std::map<FaceKey, dealii::types::boundary_id> sides; // of boundary faces
    std::map<FaceKey, dealii::types::manifold_id> faces; // whose new vertices lie on a manifold
    std::map<unsigned int, dealii::types::manifold_id> cells;
    /** Null: a TransfiniteInterpolationManifold, which is made anew for each mesh. */
    std::map<dealii::types::manifold_id, std::shared_ptr<dealii::Manifold<dim>>> manifolds;

    /** Give a mesh that has been made of `coarse` its sides and manifolds. */
    void mark(dealii::Triangulation<dim> &mesh) const;
  };

  /**
   * That of a body without a lattice: from a mesh file, from a generator of deal.II, with holes
   * whose rims it follows, or between lines. Throws UserError. Collective.
   */
  template <int dim>
  GivenMesh<dim> given_mesh(const Domain<dim> &domain, const MPI_Comm communicator);
} // namespace PeriDeal
