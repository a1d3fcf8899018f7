// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/fe/fe_dgq.h>

#include <perideal/operators/solid/state_operator.h>

#include "benchmark_problem.h"

namespace PeriDeal
{
  /** The state-based operator of a scene of peridynamics with nodes at the centres of cells. */
  template <int dim>
  struct ElasticBody
  {
    explicit ElasticBody(const std::string &text)
    {
      parse_scene(SceneText{"benchmark", text}, scene);
      std::vector<std::string> notes;
      mesh    = build_mesh(scene, MPI_COMM_WORLD, notes);
      handler = std::make_unique<dealii::DoFHandler<dim>>(*mesh);
      handler->distribute_dofs(dealii::FE_DGQ<dim>(0));
      number_along_lattice(*handler, scene.domain);
      nodes = std::make_unique<Nodes<dim>>(*handler,
                                           scene.domain,
                                           scene.cracks,
                                           scene.peridynamics.sampling.nodal_volume);
      op    = std::make_unique<StateOperator<dim>>(*nodes, scene);
    }

    Scene<dim>                                  scene;
    std::unique_ptr<dealii::Triangulation<dim>> mesh;
    std::unique_ptr<dealii::DoFHandler<dim>>    handler;
    std::unique_ptr<Nodes<dim>>                 nodes;
    std::unique_ptr<StateOperator<dim>>         op;
  };
} // namespace PeriDeal
