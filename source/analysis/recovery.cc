// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <perideal/analysis/heat_flux.h>
#include <perideal/analysis/recovery.h>
#include <perideal/base/instantiate.h>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  RecoveryIndicators recovery_indicators(const DoFHandler<dim>   &dofs,
                                         const Material          &material,
                                         const std::vector<bool> &cut,
                                         const Vector            &u)
  {
    VectorField<dim> smooth;
    for (Vector &component : smooth)
      component.reinit(u.get_partitioner());
    element_heat_flux<dim>(dofs, material, cut, u, smooth);
    for (Vector &component : smooth)
      component.update_ghost_values();
    FEValues<dim>                    values(dofs.get_fe(),
                         QGauss<dim>(dofs.get_fe().degree + 1),
                         update_values | update_gradients | update_quadrature_points |
                           update_JxW_values);
    std::vector<Tensor<1, dim>>      gradients(values.n_quadrature_points);
    std::vector<double>              temperatures(values.n_quadrature_points);
    std::vector<std::vector<double>> recovered(dim, temperatures);
    RecoveryIndicators               result;
    result.squares.resize(dofs.get_triangulation().n_active_cells());
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned() && !cut[cell->active_cell_index()])
        {
          values.reinit(cell);
          values.get_function_gradients(u, gradients);
          values.get_function_values(u, temperatures);
          for (unsigned int d = 0; d < dim; ++d)
            values.get_function_values(smooth[d], recovered[d]);
          double &square = result.squares[cell->active_cell_index()];
          for (const unsigned int q : values.quadrature_point_indices())
            {
              const double kappa =
                material.conductivity.value(values.quadrature_point(q), temperatures[q]);
              result.energy += kappa * gradients[q].norm_square() * values.JxW(q);
              result.size += kappa * temperatures[q] * temperatures[q] * values.JxW(q);
              for (unsigned int d = 0; d < dim; ++d)
                {
                  const double defect = recovered[d][q] + kappa * gradients[q][d];
                  square += defect * defect / kappa * values.JxW(q);
                }
            }
        }
    result.energy = Utilities::MPI::sum(result.energy, dofs.get_communicator());
    result.size   = Utilities::MPI::sum(result.size, dofs.get_communicator());
    return result;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(recovery_indicators);
} // namespace PeriDeal
