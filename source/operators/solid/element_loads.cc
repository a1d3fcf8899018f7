// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/quadrature_lib.h>

#include <perideal/base/instantiate.h>
#include <perideal/operators/solid/element_loads.h>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  ElementLoads<dim>::ElementLoads(const DoFHandler<dim>     &dofs,
                                  const BodyParameters<dim> &body,
                                  const Layout              &nodes,
                                  const IsHanging           &is_hanging)
    : dofs(dofs)
    , body(body)
    , nodes(nodes)
    , condition_faces(dofs, body.boundary_conditions)
    , of_parts(unknowns_of_parts(dofs,
                                 body.boundary_conditions,
                                 [&](const auto node) { return is_hanging(dim * node); }))
    , cell_values(dofs.get_fe(),
                  QGauss<dim>(dofs.get_fe().degree + 1),
                  update_values | update_quadrature_points | update_JxW_values)
    , face_values(dofs.get_fe(),
                  QGauss<dim - 1>(dofs.get_fe().degree + 1),
                  update_values | update_quadrature_points | update_JxW_values)
    , indices(dofs.get_fe().n_dofs_per_cell())
  {}


  template <int dim>
  template <typename Values, typename Formula>
  void ElementLoads<dim>::visit_points(const Values            &values,
                                       const Formula           &formula,
                                       const double             t,
                                       const types::boundary_id side,
                                       const Visit             &visit) const
  {
    for (const unsigned int q : values.quadrature_point_indices())
      for (unsigned int d = 0; d < dim; ++d)
        {
          const double f = formula(d).value(values.quadrature_point(q), t) * values.JxW(q);
          for (unsigned int i = 0; i < indices.size(); ++i)
            visit(side, dim * indices[i] + d, d, f * values.shape_value(i, q));
        }
  }


  template <int dim>
  void ElementLoads<dim>::visit_faces(const Cell &cell, const double t, const Visit &visit) const
  {
    for (const unsigned int f : cell->face_indices())
      if (cell->face(f)->at_boundary())
        condition_faces.for_each(
          body.boundary_conditions.traction,
          cell,
          f,
          face_values,
          [&](const VectorCondition &condition, const auto &values) {
            visit_points(
              values,
              [&](const unsigned int d) -> const Expression & { return *condition.values[d]; },
              t,
              condition.id,
              visit);
          });
  }


  template <int dim>
  void ElementLoads<dim>::for_each(const double t, const Visit &visit) const
  {
    const auto &force = body.initial_and_source.body_force;
    for (const auto &cell : dofs.active_cell_iterators())
      {
        if (!cell->is_locally_owned() || (force.empty() && !cell->at_boundary()))
          continue;
        cell->get_dof_indices(indices);
        if (!force.empty())
          {
            cell_values.reinit(cell);
            visit_points(
              cell_values,
              [&](const unsigned int d) -> const Expression & { return force[d]; },
              t,
              numbers::internal_face_boundary_id,
              visit);
          }
        visit_faces(cell, t, visit);
      }
    for (const PartUnknown<dim> &unknown : of_parts)
      for (const VectorCondition &condition : body.boundary_conditions.traction)
        for (unsigned int d = 0; condition.id == unknown.id && d < dim; ++d)
          visit(condition.id,
                dim * nodes->local_to_global(unknown.node) + d,
                d,
                unknown.share * condition.values[d]->value(unknown.position, t));
  }


  PERIDEAL_INSTANTIATE_CLASS(class ElementLoads);
} // namespace PeriDeal
