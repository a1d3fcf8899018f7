// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/quadrature_lib.h>

#include <perideal/operators/heat_loads.h>

#include <numeric>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  HeatLoads<dim>::HeatLoads(const DoFHandler<dim>                                    &dofs,
                            const std::shared_ptr<const Utilities::MPI::Partitioner> &layout,
                            const BoundaryConditions<dim>                            &conditions,
                            const Expression                                         &source,
                            const HangingNodes<dim>                                  &hanging)
    : dofs(dofs)
    , conditions(conditions)
    , source(source)
    , hanging(hanging)
    , any_source(!source.is_constant() || source.value(Point<dim>()) != 0.)
    , varies(source.depends_on_time() || conditions.depends_on_time())
    , faces(dofs, conditions)
    , of_parts(unknowns_of_parts(dofs,
                                 conditions,
                                 [&](const auto dof) { return hanging.is_hanging(dof); }))
    , values(dofs.get_fe(),
             QGauss<dim>(dofs.get_fe().degree + 1),
             update_values | update_quadrature_points | update_JxW_values)
    , face_values(dofs.get_fe(),
                  QGauss<dim - 1>(dofs.get_fe().degree + 1),
                  update_values | update_quadrature_points | update_JxW_values)
    , indices(dofs.get_fe().n_dofs_per_cell())
    , loads(layout)
  {
    if (!varies)
      assemble(0.);
    find_convection_sums();
  }


  template <int dim>
  bool HeatLoads<dim>::depends_on_time() const
  {
    return varies;
  }


  template <int dim>
  const std::vector<PartUnknown<dim>> &HeatLoads<dim>::part_unknowns() const
  {
    return of_parts;
  }


  template <int dim>
  const Vector &HeatLoads<dim>::at(const double t) const
  {
    if (varies)
      assemble(t);
    return loads;
  }


  template <int dim>
  double HeatLoads<dim>::sum() const
  {
    return sum_of_loads;
  }


  template <int dim>
  template <typename OnSource, typename OnFlux, typename OnConvection, typename OnPart>
  void HeatLoads<dim>::for_each(const OnSource     &on_source,
                                const OnFlux       &on_flux,
                                const OnConvection &on_convection,
                                const OnPart       &on_part) const
  {
    for (const auto &cell : dofs.active_cell_iterators())
      {
        if (!cell->is_locally_owned() || !(any_source || cell->at_boundary()))
          continue;
        cell->get_dof_indices(indices);
        if (any_source)
          {
            values.reinit(cell);
            on_source(values);
          }
        for (const unsigned int f : cell->face_indices())
          if (cell->face(f)->at_boundary())
            {
              faces.for_each(conditions.flux, cell, f, face_values, on_flux);
              faces.for_each(conditions.convection, cell, f, face_values, on_convection);
            }
      }
    for (const PartUnknown<dim> &unknown : of_parts)
      for (const SideCondition &flux : conditions.flux)
        if (flux.id == unknown.id)
          on_part(unknown, flux);
  }


  template <int dim>
  void HeatLoads<dim>::assemble(const double t) const
  {
    const auto add = [&](const auto &points, const auto &entering) {
      for (const unsigned int q : points.quadrature_point_indices())
        {
          const double heat = entering(points.quadrature_point(q)) * points.JxW(q);
          for (unsigned int i = 0; i < indices.size(); ++i)
            loads(indices[i]) += heat * points.shape_value(i, q);
        }
    };
    loads = 0.;
    for_each(
      [&](const auto &points) {
        for (const unsigned int q : points.quadrature_point_indices())
          {
            const double density = source.value(points.quadrature_point(q), t);
            for (unsigned int i = 0; i < indices.size(); ++i)
              loads(indices[i]) += density * points.shape_value(i, q) * points.JxW(q);
          }
      },
      [&](const SideCondition &flux, const auto &points) {
        add(points, [&](const Point<dim> &p) { return flux.value.value(p, t); });
      },
      [&](const SideCondition &convection, const auto &points) {
        add(points, [&](const Point<dim> &p) {
          return convection.coefficient.value(p) * convection.value.value(p, t);
        });
      },
      [&](const PartUnknown<dim> &unknown, const SideCondition &flux) {
        loads.local_element(unknown.node) += unknown.share * flux.value.value(unknown.position, t);
      });
    loads.compress(VectorOperation::add);
    hanging.condense(loads);
    sum_of_loads = std::accumulate(loads.begin(), loads.end(), 0.);
  }


  template <int dim>
  void HeatLoads<dim>::find_convection(const Cell &cell, FullMatrix<double> &matrix) const
  {
    matrix = 0.;
    for (const unsigned int f : cell->face_indices())
      if (cell->face(f)->at_boundary())
        faces.for_each(
          conditions.convection,
          cell,
          f,
          face_values,
          [&](const SideCondition &condition, const auto &points) {
            for (const unsigned int q : points.quadrature_point_indices())
              {
                const double h =
                  condition.coefficient.value(points.quadrature_point(q)) * points.JxW(q);
                for (unsigned int i = 0; i < matrix.m(); ++i)
                  for (unsigned int j = 0; j < matrix.n(); ++j)
                    matrix(i, j) += h * points.shape_value(i, q) * points.shape_value(j, q);
              }
          });
  }


  template <int dim>
  void HeatLoads<dim>::find_convection_sums()
  {
    if (conditions.convection.empty())
      return;
    Vector sums(loads.get_partitioner());
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned() && cell->at_boundary())
        for (const unsigned int f : cell->face_indices())
          if (cell->face(f)->at_boundary())
            {
              cell->get_dof_indices(indices);
              faces.for_each(conditions.convection,
                             cell,
                             f,
                             face_values,
                             [&](const SideCondition &condition, const auto &points) {
                               for (const unsigned int q : points.quadrature_point_indices())
                                 for (unsigned int i = 0; i < indices.size(); ++i)
                                   sums(indices[i]) +=
                                     condition.coefficient.value(points.quadrature_point(q)) *
                                     points.JxW(q) * points.shape_value(i, q);
                             });
            }
    sums.compress(VectorOperation::add);
    hanging.condense(sums);
    for (unsigned int i = 0; i < sums.locally_owned_size(); ++i)
      if (sums.local_element(i) != 0.)
        convection_sums.emplace_back(i, sums.local_element(i));
  }


  template <int dim>
  double HeatLoads<dim>::through_convection(const Vector &u) const
  {
    double sum = 0.;
    for (const auto &[unknown, coefficient] : convection_sums)
      sum -= coefficient * u.local_element(unknown);
    return sum;
  }


  template <int dim>
  void HeatLoads<dim>::add_to(Balance &balance, const Vector &u, const double t) const
  {
    u.update_ghost_values();
    for_each(
      [&](const auto &points) {
        for (const unsigned int q : points.quadrature_point_indices())
          balance.sources += source.value(points.quadrature_point(q), t) * points.JxW(q);
      },
      [&](const SideCondition &flux, const auto &points) {
        for (const unsigned int q : points.quadrature_point_indices())
          balance.sides[flux.name] +=
            flux.value.value(points.quadrature_point(q), t) * points.JxW(q);
      },
      [&](const SideCondition &convection, const auto &points) {
        for (const unsigned int q : points.quadrature_point_indices())
          {
            const Point<dim> &p     = points.quadrature_point(q);
            double            value = 0.;
            for (unsigned int i = 0; i < indices.size(); ++i)
              value += u(indices[i]) * points.shape_value(i, q);
            balance.sides[convection.name] += convection.coefficient.value(p) *
                                              (convection.value.value(p, t) - value) *
                                              points.JxW(q);
          }
      },
      [&](const PartUnknown<dim> &unknown, const SideCondition &flux) {
        balance.sides[flux.name] += unknown.share * flux.value.value(unknown.position, t);
      });
    u.set_ghost_state(false);
  }


  template <int dim>
  std::size_t HeatLoads<dim>::memory_consumption() const
  {
    return loads.memory_consumption();
  }


  template class HeatLoads<1>;
  template class HeatLoads<2>;
  template class HeatLoads<3>;
} // namespace PeriDeal
