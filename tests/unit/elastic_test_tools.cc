// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "elastic_test_tools.h"

namespace PeriDeal
{
  namespace OperatorTests
  {
    template <int dim>
    Body<dim>::Body(const Settings &settings, const ModelKind model, const MPI_Comm communicator)
    {
      scene.general.set("Models", to_string(model));
      scene.general.set("Physics", "elasticity");
      set(scene, settings);
      std::vector<std::string> notes;
      mesh = build_mesh(scene, communicator, notes);
      handler.reinit(*mesh);
      if (model != ModelKind::peridynamics)
        {
          handler.distribute_dofs(dealii::FE_Q<dim>(scene.finite_elements.degree));
          std::unique_ptr<Coupling<dim>> coupling;
          if (model == ModelKind::coupled)
            {
              if (scene.domain.has_lattice())
                number_along_lattice(handler, scene.domain);
              nodes    = std::make_unique<Nodes<dim>>(handler,
                                                   scene.domain,
                                                   scene.cracks,
                                                   NodalVolume::partial);
              coupling = make_solid_coupling(*nodes, scene);
            }
          elements = std::make_unique<ElasticElements<dim>>(handler, scene, std::move(coupling));
        }
      else
        {
          if (scene.domain.nodes == NodePlacement::cell_centers)
            handler.distribute_dofs(dealii::FE_DGQ<dim>(0));
          else
            handler.distribute_dofs(dealii::FE_Q<dim>(1));
          if (scene.domain.has_lattice())
            number_along_lattice(handler, scene.domain);
          nodes  = std::make_unique<Nodes<dim>>(handler,
                                               scene.domain,
                                               scene.cracks,
                                               scene.peridynamics.sampling.nodal_volume);
          states = std::make_unique<StateOperator<dim>>(*nodes, scene);
        }
    }


    template <int dim>
    Body<dim>::~Body() = default;


    template <int dim>
    ElasticOperator &Body<dim>::op() const
    {
      return elements ? static_cast<ElasticOperator &>(*elements) : *states;
    }


    template <int dim>
    const dealii::Point<dim> &Body<dim>::position(const unsigned int node) const
    {
      return elements ? elements->position(node) : nodes->position(node);
    }


    template struct Body<1>;
    template struct Body<2>;
    template struct Body<3>;
  } // namespace OperatorTests
} // namespace PeriDeal
