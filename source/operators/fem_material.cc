// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// Conductivity and capacity that depend on the temperature, the heat in the body, and what enters
// it.

#include <deal.II/base/mpi.h>

#include <perideal/base/user_error.h>
#include <perideal/operators/fem_operator.h>
#include <perideal/operators/heat_content.h>

#include <algorithm>

#include "fem_cell_data.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  bool FEMOperator<dim>::depends_on_solution() const
  {
    return scene.material.depends_on_temperature();
  }


  template <int dim>
  void FEMOperator<dim>::find_temperatures(CellData &data) const
  {
    if (!depends_on_solution())
      return;
    if (temperatures.size() > 0)
      data.values.get_function_values(temperatures, data.temperatures);
    else
      for (const unsigned int q : data.values.quadrature_point_indices())
        data.temperatures[q] =
          scene.initial_and_source.initial_value.value(data.values.quadrature_point(q));
  }


  template <int dim>
  double FEMOperator<dim>::center_conductivity(const Cell &cell) const
  {
    double T = 0.;
    if (scene.material.conductivity.depends_on_temperature())
      {
        if (temperatures.size() > 0)
          for (const unsigned int v : cell->vertex_indices())
            T += temperatures(cell->vertex_dof_index(v, 0)) / cell->n_vertices();
        else
          T = scene.initial_and_source.initial_value.value(cell->center());
      }
    return scene.material.conductivity.value(cell->center(), T);
  }


  template <int dim>
  void FEMOperator<dim>::take_material_at(const Vector &u)
  {
    if (!depends_on_solution())
      return;
    temperatures = u;
    temperatures.update_ghost_values();
    stiffness = 0.;
    mass      = 0.;
    capacity  = 0.;
    fill();
    std::string message;
    for (unsigned int i = 0; i < capacity.locally_owned_size() && message.empty(); ++i)
      {
        const auto index                    = capacity.get_partitioner()->local_to_global(i);
        stiffness_diagonal.local_element(i) = stiffness.diag_element(index);
        if (!(stiffness_diagonal.local_element(i) > 0.) || !(capacity.local_element(i) > 0.))
          message =
            "'Conductivity', 'Density' or 'Heat capacity' in section 'Material' is not positive at the temperatures near " +
            place_of(i) + "; they must be positive at every temperature that the run reaches.";
      }
    throw_on_all_if_any(dofs.get_communicator(), message);
    find_gershgorin();
  }


  template <int dim>
  bool FEMOperator<dim>::capacity_depends_on_solution() const
  {
    return scene.material.storage_depends_on_temperature();
  }


  template <int dim>
  void FEMOperator<dim>::heat_between(Vector &y, const Vector &u, const Vector &v) const
  {
    if (!capacity_depends_on_solution())
      {
        Operator::heat_between(y, u, v);
        hanging.set(y, 0.); // the nodes they follow from have all of it
        return;
      }
    CellData            &data = *cell_data;
    std::vector<double> &from = data.temperatures, &to = data.temperatures_after;
    const bool           lumped = capacity_is_diagonal();
    y                           = 0.;
    u.update_ghost_values();
    v.update_ghost_values();
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          data.values.reinit(cell);
          cell->get_dof_indices(data.indices);
          data.values.get_function_values(u, from);
          data.values.get_function_values(v, to);
          for (const unsigned int q : data.values.quadrature_point_indices())
            {
              const Point<dim> &p   = data.values.quadrature_point(q);
              const double      gap = to[q] - from[q];
              const double      heat =
                data.values.JxW(q) * heat_between_temperatures(scene.material, p, from[q], to[q]);
              // The mean capacity on the way, times the change of each unknown or of the field.
              const double mean =
                gap != 0. ? heat / gap : data.values.JxW(q) * scene.material.storage(p, from[q]);
              for (unsigned int i = 0; i < data.indices.size(); ++i)
                {
                  const auto dof = data.indices[i];
                  y(dof) +=
                    data.values.shape_value(i, q) * (lumped ? mean * (v(dof) - u(dof)) : heat);
                }
            }
        }
    u.set_ghost_state(false);
    v.set_ghost_state(false);
    y.compress(VectorOperation::add);
    hanging.condense(y);
  }


  template <int dim>
  double FEMOperator<dim>::heat(const Vector &u) const
  {
    return Utilities::MPI::sum(heat_of(u), dofs.get_communicator());
  }


  template <int dim>
  double FEMOperator<dim>::heat_of(const Vector &u) const
  {
    double heat = 0.;
    if (!scene.material.storage_depends_on_temperature() && !scene.time.steady)
      {
        for (unsigned int i = 0; i < capacity.locally_owned_size(); ++i)
          heat += capacity.local_element(i) * u.local_element(i);
        for (const unsigned int node : hanging.owned())
          heat -= capacity.local_element(node) * u.local_element(node);
        return heat;
      }
    CellData           &data = *cell_data;
    std::vector<double> T(data.values.n_quadrature_points);
    u.update_ghost_values();
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          data.values.reinit(cell);
          data.values.get_function_values(u, T);
          for (const unsigned int q : data.values.quadrature_point_indices())
            heat += data.values.JxW(q) *
                    heat_content(scene.material, data.values.quadrature_point(q), T[q]);
        }
    u.set_ghost_state(false);
    return heat;
  }


#define PERIDEAL_INSTANTIATE(dim)                                                                 \
  template bool   FEMOperator<dim>::capacity_depends_on_solution() const;                         \
  template void   FEMOperator<dim>::heat_between(Vector &, const Vector &, const Vector &) const; \
  template bool   FEMOperator<dim>::depends_on_solution() const;                                  \
  template void   FEMOperator<dim>::find_temperatures(CellData &) const;                          \
  template double FEMOperator<dim>::center_conductivity(const Cell &) const;                      \
  template void   FEMOperator<dim>::take_material_at(const Vector &);                             \
  template double FEMOperator<dim>::heat(const Vector &) const;                                   \
  template double FEMOperator<dim>::heat_of(const Vector &) const;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
