// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/analysis/heat_flux.h>
#include <perideal/problems/diffusion_problem.h>

#include <memory>
#include <string>

namespace PeriDeal
{
  /**
   * Finite elements, the model `coupled`, or peridynamics by exchange, which is `coupled` with the
   * zone everywhere.
   */
  template <int dim>
  std::unique_ptr<DiffusionField<dim>> make_element_diffusion(Model<dim>       &model,
                                                              const Scene<dim> &scene);

  /** Peridynamics by bonds alone. */
  template <int dim>
  std::unique_ptr<DiffusionField<dim>> make_bond_diffusion(Model<dim>       &model,
                                                           const Scene<dim> &scene);


  template <int dim>
  OutputField vector_field(const std::string &name, VectorField<dim> &components)
  {
    OutputField field;
    field.name = name;
    for (Vector &component : components)
      {
        component.update_ghost_values();
        field.components.push_back(std::move(component));
      }
    return field;
  }
} // namespace PeriDeal
