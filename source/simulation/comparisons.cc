// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// The models against each other and against an exact solution.

#include <perideal/simulation/simulation.h>

#include "result_record.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void Simulation<dim>::add_errors(const double t)
  {
    if (!exact)
      return;
    for (const auto &model : models)
      {
        const Difference error = model->error(model->solution, [&](const Point<dim> &p) {
          double x[dim];
          for (unsigned int d = 0; d < dim; ++d)
            x[d] = p[d];
          return exact->value(x, t);
        });
        record->errors[model->name()]["relative l2"].push_back({t, error.relative_l2});
        record->errors[model->name()]["maximum"].push_back({t, error.maximum});
      }
  }


  template <int dim>
  void Simulation<dim>::compare_models(const double t)
  {
    const ModelRun<dim> *fem = nullptr, *pd = nullptr;
    for (const auto &model : models)
      if (model->name() != to_string(ModelKind::coupled))
        (model->name() == to_string(ModelKind::finite_elements) ? fem : pd) = model.get();
      else
        compare_with_others(t, *model);
    if (fem == nullptr || pd == nullptr)
      return;
    pd->op().initialize_vector(difference);
    interpolate_to(fem->dofs(), fem->solution, pd->dofs(), difference);
    const Difference size = nodal_difference(pd->solution, difference, [&](const unsigned int i) {
      return pd->volume_of(i);
    });
    record->comparison["relative l2"].push_back({t, size.relative_l2});
    record->comparison["maximum"].push_back({t, size.maximum});
    difference.sadd(-1., 1., pd->solution);
    difference.update_ghost_values();
  }


  template <int dim>
  void Simulation<dim>::compare_with_others(const double t, const ModelRun<dim> &coupled)
  {
    Vector values;
    for (const auto &other : models)
      if (other.get() != &coupled)
        {
          coupled.op().initialize_vector(values);
          interpolate_to(other->dofs(), other->solution, coupled.dofs(), values);
          const Difference size =
            nodal_difference(coupled.solution, values, [&](const unsigned int i) {
              return coupled.volume_of(i);
            });
          auto &entry = record->comparisons[coupled.name() + " minus " + other->name()];
          entry["relative l2"].push_back({t, size.relative_l2});
          entry["maximum"].push_back({t, size.maximum});
        }
  }


#define PERIDEAL_INSTANTIATE(dim)                          \
  template void Simulation<dim>::add_errors(const double); \
  template void Simulation<dim>::compare_models(const double);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
