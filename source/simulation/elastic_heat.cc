// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// The temperature of elastic bodies, computed by the heat problem of the same scene.

#include <perideal/simulation/elastic_simulation.h>

#include "result_record.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /**
     * The temperature above the reference at the nodes of the elastic model. Both models have the
     * same element on the same mesh, but may number its nodes differently; each node has the same
     * owner in both.
     */
    template <int dim>
    void find_temperature_change(const ModelRun<dim>   &heat,
                                 const ElasticRun<dim> &elastic,
                                 const double           reference,
                                 Vector                &change)
    {
      const DoFHandler<dim> &from = heat.dofs(), &to = elastic.dofs();
      AssertDimension(from.get_fe().n_dofs_per_cell(), to.get_fe().n_dofs_per_cell());
      std::vector<types::global_dof_index> source(from.get_fe().n_dofs_per_cell()), target(source);
      const auto                          &owned = *change.get_partitioner();
      auto                                 cell  = to.begin_active();
      for (const auto &of_heat : from.active_cell_iterators())
        {
          if (cell->is_locally_owned())
            {
              of_heat->get_dof_indices(source);
              cell->get_dof_indices(target);
              for (unsigned int i = 0; i < source.size(); ++i)
                if (owned.in_local_range(target[i]))
                  change(target[i]) = heat.solution(source[i]) - reference;
            }
          ++cell;
        }
    }
  } // namespace


  template <int dim>
  void ElasticSimulation<dim>::build_heat()
  {
    if (!scene.heat)
      return;
    progress.line("the heat problem of the temperature:");
    heat = std::make_unique<Simulation<dim>>(*scene.heat, text, communicator, quiet);
    heat->build_on(mesh);
    for (const std::string &note : heat->notes())
      record->notes.push_back("temperature: " + note);
  }


  template <int dim>
  void ElasticSimulation<dim>::warm_until(const double t)
  {
    if (!heat)
      return;
    {
      Timings::Scope scope(timings, "heat problem");
      heat->advance_to(t);
    }
    for (unsigned int k = 0; k < models.size(); ++k)
      {
        ElasticRun<dim> &model = *models[k];
        Timings::Scope   scope(model.timings, "thermal loads");
        Vector           change;
        model.op().initialize_nodal_vector(change);
        find_temperature_change(heat->model(k),
                                model,
                                scene.elasticity.reference_temperature,
                                change);
        model.op().set_temperature_change(change);
      }
  }


#define PERIDEAL_INSTANTIATE(dim)                     \
  template void ElasticSimulation<dim>::build_heat(); \
  template void ElasticSimulation<dim>::warm_until(const double);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
