// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <perideal/analysis/comparison.h>
#include <perideal/base/instantiate.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    Difference reduce(double square, double reference, double maximum, const MPI_Comm communicator)
    {
      square    = Utilities::MPI::sum(square, communicator);
      reference = Utilities::MPI::sum(reference, communicator);
      Difference difference;
      difference.maximum     = Utilities::MPI::max(maximum, communicator);
      difference.relative_l2 = std::sqrt(reference > 0. ? square / reference : square);
      return difference;
    }
  } // namespace


  template <int dim>
  void interpolate_to(const DoFHandler<dim> &fem_dofs,
                      const Vector          &u,
                      const DoFHandler<dim> &other_dofs,
                      Vector                &values)
  {
    const FiniteElement<dim>            &fe = other_dofs.get_fe();
    FEValues<dim>                        at_points(fem_dofs.get_fe(),
                            Quadrature<dim>(fe.get_unit_support_points()),
                            update_values);
    std::vector<double>                  cell_values(fe.n_dofs_per_cell());
    std::vector<types::global_dof_index> indices(fe.n_dofs_per_cell());
    for (const auto &cell : fem_dofs.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const typename DoFHandler<dim>::active_cell_iterator other(&fem_dofs.get_triangulation(),
                                                                     cell->level(),
                                                                     cell->index(),
                                                                     &other_dofs);
          at_points.reinit(cell);
          at_points.get_function_values(u, cell_values);
          other->get_dof_indices(indices);
          for (unsigned int i = 0; i < indices.size(); ++i)
            if (values.in_local_range(indices[i]))
              values(indices[i]) = cell_values[i];
        }
  }


  Difference nodal_difference(const Vector                              &a,
                              const Vector                              &b,
                              const std::function<double(unsigned int)> &volume)
  {
    double square = 0., reference = 0., maximum = 0.;
    for (unsigned int i = 0; i < a.locally_owned_size(); ++i)
      {
        const double difference = a.local_element(i) - b.local_element(i), v = volume(i);
        square += v * difference * difference;
        reference += v * b.local_element(i) * b.local_element(i);
        maximum = std::max(maximum, std::abs(difference));
      }
    return reduce(square, reference, maximum, a.get_mpi_communicator());
  }


  template <int dim>
  Difference element_difference(const DoFHandler<dim>                                   &dofs,
                                const Vector                                            &u,
                                const std::function<double(const dealii::Point<dim> &)> &exact)
  {
    FEValues<dim>       values(dofs.get_fe(),
                         QGauss<dim>(dofs.get_fe().degree + 3),
                         update_values | update_quadrature_points | update_JxW_values);
    std::vector<double> at_points(values.n_quadrature_points);
    double              square = 0., reference = 0., maximum = 0.;
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          values.reinit(cell);
          values.get_function_values(u, at_points);
          for (const unsigned int q : values.quadrature_point_indices())
            {
              const double expected   = exact(values.quadrature_point(q));
              const double difference = at_points[q] - expected;
              square += difference * difference * values.JxW(q);
              reference += expected * expected * values.JxW(q);
              maximum = std::max(maximum, std::abs(difference));
            }
        }
    return reduce(square, reference, maximum, dofs.get_communicator());
  }


  PERIDEAL_INSTANTIATE_FUNCTION(interpolate_to);
  PERIDEAL_INSTANTIATE_FUNCTION(element_difference);
} // namespace PeriDeal
