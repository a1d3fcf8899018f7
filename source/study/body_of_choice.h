// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/scene.h>
#include <perideal/study/cracked_box.h>

#include <memory>
#include <utility>
#include <vector>

#include "given_body.h"

namespace PeriDeal
{
  /** The body of a scene with `Models = auto`, as the choice of a mesh sees it. */
  template <int dim>
  struct BodyOfChoice
  {
    /**
     * A box is a lattice, a plate with holes a mesh that follows their rims, with as few cells as
     * can be; the others have their mesh. Throws UserError. Collective.
     */
    BodyOfChoice(const Scene<dim> &scene, const MPI_Comm communicator);

    /**
     * Cells of a plate with round holes that are about so many times as many along each edge as
     * those of the coarsest mesh, more along each, and how many times the fewest are. Not
     * collective.
     */
    std::pair<CellCounts, double> finer_plate(const double times) const;

    /** The scene; `lower` and `upper` are corners of the box around the body in any case. */
    std::shared_ptr<Scene<dim>>     scene;
    std::vector<Setting>            settings; // of its coarsest mesh
    std::unique_ptr<GivenBody<dim>> given;    // of a body without a lattice, else null
    SidePoints<dim>                 sides;
  };
} // namespace PeriDeal
