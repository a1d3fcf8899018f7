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
    if (!this->tangents.any())
      return;
    Vector mark(layout);
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned() && has_tangents(cell))
        {
          cell->get_dof_indices(indices);
          for (const auto dof : indices)
            mark(dof) += 1.;
        }
    mark.compress(VectorOperation::add);
    hanging.condense(mark);
    for (unsigned int i = 0; i < mark.locally_owned_size(); ++i)
      if (mark.local_element(i) != 0.)
        this->curved.push_back(i);
  }


  template <int dim>
  bool HeatLoads<dim>::has_tangents(const Cell &cell) const
  {
    bool found = this->tangents.of_source();
    if (!found && this->tangents.any() && cell->at_boundary())
      on_faces(cell, [&](const SurfaceTransfer &transfer, const auto &) {
        found = found || transfer.depends_on_temperature();
      });
    return found;
  }


  template <int dim>
  template <typename Values>
  double HeatLoads<dim>::taken_at(const Values &points, const unsigned int q) const
  {
    if (!this->tangents.taken_at_all())
      return 0.;
    const Vector &T     = this->tangents.temperatures();
    double        value = 0.;
    for (unsigned int i = 0; i < indices.size(); ++i)
      value += T(indices[i]) * points.shape_value(i, q);
    return value;
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
        if (!is_known(this->tangents.of_source()))
          return;
        for (const unsigned int q : points.quadrature_point_indices())
          {
            const double density =
              this->tangents.given(points.quadrature_point(q), t, taken_at(points, q));
            for (unsigned int i = 0; i < indices.size(); ++i)
              loads(indices[i]) += density * points.shape_value(i, q) * points.JxW(q);
          }
      },
      [&](const SurfaceTransfer &transfer, const auto &points) {
        if (!is_known(transfer.depends_on_temperature()))
          return;
        for (const unsigned int q : points.quadrature_point_indices())
          {
            const double heat =
              this->tangents.given(transfer, points.quadrature_point(q), t, taken_at(points, q)) *
              points.JxW(q);
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


  namespace
  {
    /** Add int h N_i N_j of a point. */
    template <typename Values>
    void add_squares(const Values       &points,
                     const unsigned int  q,
                     const double        h,
                     FullMatrix<double> &matrix)
    {
      const double weight = h * points.JxW(q);
      for (unsigned int i = 0; i < matrix.m(); ++i)
        for (unsigned int j = 0; j < matrix.n(); ++j)
          matrix(i, j) += weight * points.shape_value(i, q) * points.shape_value(j, q);
    }
  } // namespace


  template <int dim>
  void HeatLoads<dim>::find_transfer(const Cell &cell, FullMatrix<double> &matrix) const
  {
    matrix = 0.;
    on_faces(cell, [&](const SurfaceTransfer &transfer, const auto &points) {
      if (transfer.fixes_level() && !transfer.depends_on_temperature())
        for (const unsigned int q : points.quadrature_point_indices())
          add_squares(points, q, transfer.coefficient.value(points.quadrature_point(q)), matrix);
    });
  }


  template <int dim>
  bool HeatLoads<dim>::find_tangents(const Cell &cell, FullMatrix<double> &matrix) const
  {
    const auto &tangents = this->tangents;
    if (!tangents.taken_at_all() || !has_tangents(cell))
      return false;
    matrix = 0.;
    cell->get_dof_indices(indices);
    on_slopes(cell, [&](const auto &points, const unsigned int q, const double h) {
      add_squares(points, q, h, matrix);
    });
    return true;
  }


  template <int dim>
  template <typename Visit>
  void HeatLoads<dim>::on_slopes(const Cell &cell, const Visit &visit) const
  {
    const auto &tangents = this->tangents;
    if (tangents.of_source())
      {
        values.reinit(cell);
        for (const unsigned int q : values.quadrature_point_indices())
          visit(values, q, tangents.slope(values.quadrature_point(q), taken_at(values, q)));
      }
    on_faces(cell, [&](const SurfaceTransfer &transfer, const auto &points) {
      if (transfer.depends_on_temperature())
        for (const unsigned int q : points.quadrature_point_indices())
          visit(points,
                q,
                tangents.slope(transfer, points.quadrature_point(q), taken_at(points, q)));
    });
  }


  template <int dim>
  void HeatLoads<dim>::find_coefficients()
  {
    this->coefficients.clear();
    if (!conditions.transfers_fix_level() && !this->tangents.of_source())
      return;
    Vector     sums(loads.get_partitioner());
    const auto add = [&](const auto &points, const unsigned int q, const double h) {
      for (unsigned int i = 0; i < indices.size(); ++i)
        sums(indices[i]) += h * points.JxW(q) * points.shape_value(i, q);
    };
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned() && (cell->at_boundary() || this->tangents.of_source()))
        {
          cell->get_dof_indices(indices);
          on_faces(cell, [&](const SurfaceTransfer &transfer, const auto &points) {
            if (!transfer.depends_on_temperature())
              for (const unsigned int q : points.quadrature_point_indices())
                add(points, q, transfer.coefficient.value(points.quadrature_point(q)));
          });
          if (this->tangents.taken_at_all())
            on_slopes(cell, add);
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
    const double undershoot = this->tangents.undershoot_of(u);
    u.update_ghost_values();
    const auto value_at = [&](const auto &points, const unsigned int q) {
      double value = 0.;
      for (unsigned int i = 0; i < indices.size(); ++i)
        value += u(indices[i]) * points.shape_value(i, q);
      return value;
    };
    for_each(
      [&](const auto &points) {
        for (const unsigned int q : points.quadrature_point_indices())
          balance.sources += source.value(points.quadrature_point(q),
                                          t,
                                          this->tangents.of_source() ? value_at(points, q) : 0.) *
                             points.JxW(q);
      },
      [&](const SurfaceTransfer &transfer, const auto &points) {
        for (const unsigned int q : points.quadrature_point_indices())
          balance.sides[transfer.name] += this->tangents.entering(transfer,
                                                                  points.quadrature_point(q),
                                                                  t,
                                                                  value_at(points, q),
                                                                  undershoot) *
                                          points.JxW(q);
      },
      [&](const PartUnknown<dim> &unknown, const SurfaceTransfer &transfer) {
        balance.sides[transfer.name] += unknown.share * transfer.flux.value(unknown.position, t);
      });
    u.set_ghost_state(false);
  }


  PERIDEAL_INSTANTIATE_CLASS(class HeatLoads);
} // namespace PeriDeal
