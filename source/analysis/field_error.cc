// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>
#include <deal.II/base/mpi_remote_point_evaluation.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q1.h>
#include <deal.II/numerics/vector_tools_evaluate.h>

#include <perideal/analysis/field_error.h>
#include <perideal/analysis/point_evaluator.h>
#include <perideal/analysis/quadratic_elements.h>
#include <perideal/base/instantiate.h>
#include <perideal/operators/parts/element_layout.h>

#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  FieldError<dim>::FieldError(const QuadraticElements<dim> &elements,
                              const SolveSystem            &solve,
                              const Vector                 &u,
                              const double                  t)
    : elements(elements)
    , error(elements.recovered_bubbles(u))
  {
    const CellTerm<dim>      &cells = cells_of(elements.linear_operator());
    const FieldOperator<dim> &op    = elements.linear_operator();
    error += elements.prescribed_bubbles(u, t);
    Vector field = elements.prolonged(u);
    field += error;
    // What is left of the equations of Q1, all of it in cells that are left out.
    residual      = elements.residual(field, t);
    Vector defect = elements.restricted(residual);
    defect -= elements.linear_residual(u, t);
    Vector rhs, change, image;
    op.initialize_vector(rhs);
    change.reinit(rhs);
    image.reinit(rhs);
    op.residual(rhs, u, t);
    for (unsigned int i = 0; i < rhs.locally_owned_size(); ++i)
      rhs.local_element(i) += defect.local_element(i);
    const Vector everywhere(rhs);
    op.clear_constrained(rhs);
    solve(change, rhs);
    cells.hanging_nodes().interpolate(change);
    error += elements.prolonged(change);
    op.multiply(image, change);
    changed_reactions = image;
    changed_reactions -= everywhere;
  }


  template <int dim>
  double FieldError<dim>::root_mean_square() const
  {
    return elements.root_mean_square(error);
  }


  template <int dim>
  std::vector<double> FieldError<dim>::at(const std::vector<std::vector<double>> &points) const
  {
    return PointEvaluator<dim>(elements.dof_handler(),
                               nullptr,
                               elements.parameters().cracks,
                               points,
                               "'Probes' in section 'Output'")
      .evaluate(error);
  }


  template <int dim>
  double FieldError<dim>::of_flow_through(const std::string &side) const
  {
    const CellTerm<dim> &cells = cells_of(elements.linear_operator());
    Vector               marks(changed_reactions);
    mark_side(cells.dof_handler(),
              *marks.get_partitioner(),
              elements.parameters(),
              cells.hanging_nodes(),
              side,
              marks);
    return marks * changed_reactions - residual * elements.boundary_bubbles(side, marks);
  }


  template <int dim>
  double difference_on_meshes(const DoFHandler<dim> &dofs,
                              const Vector          &u,
                              const DoFHandler<dim> &other_dofs,
                              const Vector          &other)
  {
    const auto ghosted = [](const DoFHandler<dim> &of, const Vector &v) {
      return with_ghosts(v, element_layout(of, static_cast<const Coupling<dim> *>(nullptr)));
    };
    const Vector            field = ghosted(dofs, u), other_field = ghosted(other_dofs, other);
    FEValues<dim>           values(dofs.get_fe(),
                         QGauss<dim>(dofs.get_fe().degree + 1),
                         update_values | update_quadrature_points | update_JxW_values);
    std::vector<double>     of_cell(values.n_quadrature_points), here, weights;
    std::vector<Point<dim>> points;
    for (const auto &cell : dofs.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          values.reinit(cell);
          values.get_function_values(field, of_cell);
          here.insert(here.end(), of_cell.begin(), of_cell.end());
          for (const unsigned int q : values.quadrature_point_indices())
            {
              points.push_back(values.quadrature_point(q));
              weights.push_back(values.JxW(q));
            }
        }
    const MappingQ1<dim>                            mapping;
    Utilities::MPI::RemotePointEvaluation<dim, dim> there;
    there.reinit(points, other_dofs.get_triangulation(), mapping);
    const std::vector<double> at_points =
      VectorTools::point_values<1>(there, other_dofs, other_field);
    double square = 0., volume = 0.;
    for (std::size_t q = 0; q < points.size(); ++q)
      if (there.point_found(q))
        {
          square += weights[q] * (here[q] - at_points[q]) * (here[q] - at_points[q]);
          volume += weights[q];
        }
    const MPI_Comm communicator = dofs.get_communicator();
    return std::sqrt(Utilities::MPI::sum(square, communicator) /
                     Utilities::MPI::sum(volume, communicator));
  }


  double extrapolated_error(const double difference,
                            const double coarse_size,
                            const double fine_size,
                            const double order)
  {
    return difference / (std::pow(coarse_size / fine_size, order) - 1.);
  }


  PERIDEAL_INSTANTIATE_CLASS(class FieldError);
  PERIDEAL_INSTANTIATE_FUNCTION(difference_on_meshes);
} // namespace PeriDeal
