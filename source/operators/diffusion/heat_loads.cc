// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/quadrature_lib.h>

#include <perideal/base/instantiate.h>
#include <perideal/operators/diffusion/heat_loads.h>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  HeatLoads<dim>::HeatLoads(const DoFHandler<dim>                                    &dofs,
                            const std::shared_ptr<const Utilities::MPI::Partitioner> &layout,
                            const BoundaryConditions<dim>                            &conditions,
                            const Expression                                         &source,
                            const HangingNodes<dim>                                  &hanging)
    : DiffusionLoads<dim>(layout, conditions, source)
    , dofs(dofs)
    , hanging(hanging)
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
  {
    if (!this->varies)
      this->find(0.);
    find_coefficients();
  }


  template <int dim>
  template <typename Visit>
  void HeatLoads<dim>::on_faces(const Cell &cell, const Visit &visit) const
  {
    for (const unsigned int f : cell->face_indices())
      if (cell->face(f)->at_boundary())
        faces.for_each(conditions.transfers, cell, f, face_values, visit);
  }


  template <int dim>
  template <typename OnSource, typename OnSide, typename OnPart>
  void HeatLoads<dim>::for_each(const OnSource &on_source,
                                const OnSide   &on_side,
                                const OnPart   &on_part) const
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
        on_faces(cell, on_side);
      }
    for (const PartUnknown<dim> &unknown : of_parts)
      for (const SurfaceTransfer &transfer : conditions.transfers)
        if (transfer.id == unknown.id)
          on_part(unknown, transfer);
  }


  template <int dim>
  void HeatLoads<dim>::assemble(const double t) const
  {
    for_each(
      [&](const auto &points) {
        for (const unsigned int q : points.quadrature_point_indices())
          {
            const double density = source.value(points.quadrature_point(q), t);
            for (unsigned int i = 0; i < indices.size(); ++i)
              loads(indices[i]) += density * points.shape_value(i, q) * points.JxW(q);
          }
      },
      [&](const SurfaceTransfer &transfer, const auto &points) {
        for (const unsigned int q : points.quadrature_point_indices())
          {
            const double heat =
              transfer.entering(points.quadrature_point(q), t, 0.) * points.JxW(q);
            for (unsigned int i = 0; i < indices.size(); ++i)
              loads(indices[i]) += heat * points.shape_value(i, q);
          }
      },
      [&](const PartUnknown<dim> &unknown, const SurfaceTransfer &transfer) {
        loads.local_element(unknown.node) +=
          unknown.share * transfer.flux.value(unknown.position, t);
      });
    loads.compress(VectorOperation::add);
    hanging.condense(loads);
  }


  template <int dim>
  void HeatLoads<dim>::find_transfer(const Cell &cell, FullMatrix<double> &matrix) const
  {
    matrix = 0.;
    on_faces(cell, [&](const SurfaceTransfer &transfer, const auto &points) {
      if (transfer.fixes_level())
        for (const unsigned int q : points.quadrature_point_indices())
          {
            const double h = transfer.coefficient.value(points.quadrature_point(q)) * points.JxW(q);
            for (unsigned int i = 0; i < matrix.m(); ++i)
              for (unsigned int j = 0; j < matrix.n(); ++j)
                matrix(i, j) += h * points.shape_value(i, q) * points.shape_value(j, q);
          }
    });
  }


  template <int dim>
  void HeatLoads<dim>::find_coefficients()
  {
    if (!conditions.transfers_fix_level())
      return;
    Vector sums(loads.get_partitioner());
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned() && cell->at_boundary())
        {
          cell->get_dof_indices(indices);
          on_faces(cell, [&](const SurfaceTransfer &transfer, const auto &points) {
            for (const unsigned int q : points.quadrature_point_indices())
              for (unsigned int i = 0; i < indices.size(); ++i)
                sums(indices[i]) += transfer.coefficient.value(points.quadrature_point(q)) *
                                    points.JxW(q) * points.shape_value(i, q);
          });
        }
    sums.compress(VectorOperation::add);
    hanging.condense(sums);
    for (unsigned int i = 0; i < sums.locally_owned_size(); ++i)
      if (sums.local_element(i) != 0.)
        this->coefficients.emplace_back(i, sums.local_element(i));
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
      [&](const SurfaceTransfer &transfer, const auto &points) {
        for (const unsigned int q : points.quadrature_point_indices())
          {
            double value = 0.;
            for (unsigned int i = 0; i < indices.size(); ++i)
              value += u(indices[i]) * points.shape_value(i, q);
            balance.sides[transfer.name] +=
              transfer.entering(points.quadrature_point(q), t, value) * points.JxW(q);
          }
      },
      [&](const PartUnknown<dim> &unknown, const SurfaceTransfer &transfer) {
        balance.sides[transfer.name] += unknown.share * transfer.flux.value(unknown.position, t);
      });
    u.set_ghost_state(false);
  }


  PERIDEAL_INSTANTIATE_CLASS(class HeatLoads);
} // namespace PeriDeal
