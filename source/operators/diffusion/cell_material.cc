// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/quadrature_lib.h>

#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>
#include <perideal/operators/diffusion/cell_material.h>
#include <perideal/operators/diffusion/heat_content.h>

#include <sstream>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  CellMaterial<dim>::CellMaterial(const DoFHandler<dim> &dofs,
                                  const Material        &material,
                                  const Expression      &initial_value,
                                  const bool             steady)
    : dofs(dofs)
    , material(material)
    , initial_value(initial_value)
    , steady(steady)
    , values(dofs.get_fe(),
             QGauss<dim>(dofs.get_fe().degree + 1),
             update_values | update_gradients | update_quadrature_points | update_JxW_values)
    , indices(dofs.get_fe().n_dofs_per_cell())
    , temperatures(values.n_quadrature_points, 0.)
    , after(temperatures)
  {
    check();
  }


  template <int dim>
  void CellMaterial<dim>::check() const
  {
    if (material.conductivity.is_constant() && material.density.is_constant() &&
        material.heat_capacity.is_constant())
      return;
    std::string   message;
    FEValues<dim> points(dofs.get_fe(), values.get_quadrature(), update_quadrature_points);
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned() && message.empty())
        {
          points.reinit(cell);
          for (const Point<dim> &p : points.get_quadrature_points())
            {
              std::ostringstream where;
              where << " at (" << p << "); it must be positive everywhere in the body.";
              const double T = initial_value.value(p);
              if (!(material.conductivity.value(p, T) > 0.))
                message = "'Conductivity' in section 'Material' is not positive" + where.str();
              else if (!steady && !(material.storage(p, T) > 0.))
                message = "'Density' times 'Heat capacity' in section 'Material' is not positive" +
                          where.str();
            }
        }
    throw_on_all_if_any(dofs.get_communicator(), message);
  }


  template <int dim>
  void CellMaterial<dim>::take(const Vector &u)
  {
    taken = u;
    taken.update_ghost_values();
  }


  template <int dim>
  void CellMaterial<dim>::find_temperatures() const
  {
    if (!material.depends_on_temperature())
      return;
    if (taken.size() > 0)
      values.get_function_values(taken, temperatures);
    else
      for (const unsigned int q : values.quadrature_point_indices())
        temperatures[q] = initial_value.value(values.quadrature_point(q));
  }


  template <int dim>
  void CellMaterial<dim>::assemble(const Cell         &cell,
                                   FullMatrix<double> &stiffness,
                                   FullMatrix<double> &mass) const
  {
    values.reinit(cell);
    find_temperatures();
    stiffness            = 0.;
    mass                 = 0.;
    const unsigned int n = stiffness.m();
    for (const unsigned int q : values.quadrature_point_indices())
      {
        const Point<dim> &p       = values.quadrature_point(q);
        const double      T       = temperatures[q];
        const double      kappa   = material.conductivity.value(p, T) * values.JxW(q);
        const double      storage = (steady ? 1. : material.storage(p, T)) * values.JxW(q);
        for (unsigned int i = 0; i < n; ++i)
          for (unsigned int j = 0; j < n; ++j)
            {
              stiffness(i, j) += kappa * (values.shape_grad(i, q) * values.shape_grad(j, q));
              mass(i, j) += storage * values.shape_value(i, q) * values.shape_value(j, q);
            }
      }
  }


  template <int dim>
  void CellMaterial<dim>::assemble_unit(const Cell &cell, FullMatrix<double> &stiffness) const
  {
    values.reinit(cell);
    stiffness = 0.;
    for (const unsigned int q : values.quadrature_point_indices())
      for (unsigned int i = 0; i < stiffness.m(); ++i)
        for (unsigned int j = 0; j < stiffness.m(); ++j)
          stiffness(i, j) += values.JxW(q) * (values.shape_grad(i, q) * values.shape_grad(j, q));
  }


  template <int dim>
  bool CellMaterial<dim>::varies() const
  {
    return !material.conductivity.is_constant();
  }


  template <int dim>
  double CellMaterial<dim>::conductivity(const Cell        &cell,
                                         const Point<dim>  &p,
                                         const unsigned int vertex) const
  {
    const double T = !material.conductivity.depends_on_temperature() ? 0. :
                     taken.size() > 0 ? taken(cell->vertex_dof_index(vertex, 0)) :
                                        initial_value.value(cell->vertex(vertex));
    return material.conductivity.value(p, T);
  }


  template <int dim>
  double CellMaterial<dim>::center_conductivity(const Cell &cell) const
  {
    double T = 0.;
    if (material.conductivity.depends_on_temperature())
      {
        if (taken.size() > 0)
          for (const unsigned int v : cell->vertex_indices())
            T += taken(cell->vertex_dof_index(v, 0)) / cell->n_vertices();
        else
          T = initial_value.value(cell->center());
      }
    return material.conductivity.value(cell->center(), T);
  }


  template <int dim>
  void CellMaterial<dim>::heat_between(Vector       &y,
                                       const Vector &u,
                                       const Vector &v,
                                       const bool    lumped) const
  {
    y = 0.;
    u.update_ghost_values();
    v.update_ghost_values();
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          values.reinit(cell);
          cell->get_dof_indices(indices);
          values.get_function_values(u, temperatures);
          values.get_function_values(v, after);
          for (const unsigned int q : values.quadrature_point_indices())
            {
              const Point<dim> &p    = values.quadrature_point(q);
              const double      from = temperatures[q], gap = after[q] - from;
              const double      heat =
                values.JxW(q) * heat_between_temperatures(material, p, from, after[q]);
              // The mean capacity on the way, times the change of each unknown or of the field.
              const double mean = gap != 0. ? heat / gap :
                                              values.JxW(q) * material.storage(p, from);
              for (unsigned int i = 0; i < indices.size(); ++i)
                {
                  const auto dof = indices[i];
                  y(dof) += values.shape_value(i, q) * (lumped ? mean * (v(dof) - u(dof)) : heat);
                }
            }
        }
    u.set_ghost_state(false);
    v.set_ghost_state(false);
    y.compress(VectorOperation::add);
  }


  template <int dim>
  double CellMaterial<dim>::content(const Vector &u) const
  {
    double heat = 0.;
    u.update_ghost_values();
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          values.reinit(cell);
          values.get_function_values(u, after);
          for (const unsigned int q : values.quadrature_point_indices())
            heat += values.JxW(q) * heat_content(material, values.quadrature_point(q), after[q]);
        }
    u.set_ghost_state(false);
    return heat;
  }


  PERIDEAL_INSTANTIATE_CLASS(class CellMaterial);
} // namespace PeriDeal
