// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/quadrature_lib.h>

#include <perideal/base/instantiate.h>
#include <perideal/operators/solid/projected_strains.h>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  CellProjection<dim>::CellProjection(const FiniteElement<dim> &fe, const unsigned int n_points)
    : polynomials(Polynomials::Monomial<double>::generate_complete_basis(fe.degree - 1))
    , basis(n_points, std::vector<double>(polynomials.n()))
    , weights(n_points)
    , inverse(polynomials.n(), polynomials.n())
  {}


  template <int dim>
  void CellProjection<dim>::reinit(const FEValues<dim> &values)
  {
    const unsigned int n = polynomials.n();
    // In the coordinates themselves, not those of the unit cell, so that in distorted cells they
    // are linear functions, too.
    const auto       cell   = values.get_cell();
    const Point<dim> middle = cell->center();
    const double     size   = cell->diameter();
    inverse                 = 0.;
    for (const unsigned int q : values.quadrature_point_indices())
      {
        const Point<dim> place((values.quadrature_point(q) - middle) / size);
        weights[q] = values.JxW(q);
        for (unsigned int k = 0; k < n; ++k)
          basis[q][k] = polynomials.compute_value(k, place);
        for (unsigned int k = 0; k < n; ++k)
          for (unsigned int l = 0; l < n; ++l)
            inverse(k, l) += basis[q][k] * basis[q][l] * weights[q];
      }
    inverse.gauss_jordan();
  }


  template <int dim>
  ProjectedStrains<dim>::ProjectedStrains(const FiniteElement<dim> &fe, const bool projects)
    : projects(projects)
    , of_cell(fe,
              QGauss<dim>(fe.degree + 1),
              update_values | update_gradients | update_quadrature_points | update_JxW_values)
    , projection(fe, of_cell.n_quadrature_points)
    , means(of_cell.n_quadrature_points * of_cell.dofs_per_cell)
  {}


  template <int dim>
  void ProjectedStrains<dim>::reinit(const Cell &cell)
  {
    of_cell.reinit(cell);
    if (!projects)
      return;
    projection.reinit(of_cell);
    std::vector<Tensor<1, dim>> projected;
    for (unsigned int a = 0; a < of_cell.dofs_per_cell; ++a)
      {
        projection.find(projected, [&](const unsigned int q) -> const Tensor<1, dim> & {
          return of_cell.shape_grad(a, q);
        });
        for (unsigned int q = 0; q < projected.size(); ++q)
          means[q * of_cell.dofs_per_cell + a] = projected[q];
      }
  }


  template <int dim>
  SymmetricTensor<2, 3> ProjectedStrains<dim>::strain(const unsigned int            q,
                                                      const dealii::Vector<double> &u) const
  {
    double         dilatation = 0.;
    Tensor<2, dim> gradient;
    for (unsigned int a = 0; a < of_cell.dofs_per_cell; ++a)
      {
        const Tensor<1, dim> &of_a = of_cell.shape_grad(a, q);
        for (unsigned int d = 0; d < dim; ++d)
          {
            gradient[d] += u(dim * a + d) * of_a;
            if (projects)
              dilatation += u(dim * a + d) * (mean_gradient(a, q)[d] - of_a[d]);
          }
      }
    Strain full;
    for (unsigned int c = 0; c < dim; ++c)
      for (unsigned int d = c; d < dim; ++d)
        full[c][d] = 0.5 * (gradient[c][d] + gradient[d][c]);
    return full + dilatation / 3. * unit_symmetric_tensor<3>();
  }


  template <int dim>
  SymmetricTensor<2, 3> ProjectedStrains<dim>::of_unknown(const unsigned int a,
                                                          const unsigned int d,
                                                          const unsigned int q) const
  {
    const Tensor<1, dim> &of_a = of_cell.shape_grad(a, q);
    Strain                full;
    for (unsigned int c = 0; c < dim; ++c)
      full[c][d] = (c == d ? 1. : 0.5) * of_a[c];
    if (projects)
      full += (mean_gradient(a, q)[d] - of_a[d]) / 3. * unit_symmetric_tensor<3>();
    return full;
  }


  template <int dim>
  Tensor<1, dim> ProjectedStrains<dim>::force(const unsigned int a,
                                              const unsigned int q,
                                              const Strain      &stress) const
  {
    const Tensor<1, dim> &of_a = of_cell.shape_grad(a, q);
    Tensor<1, dim>        force;
    for (unsigned int c = 0; c < dim; ++c)
      for (unsigned int d = 0; d < dim; ++d)
        force[c] += stress[c][d] * of_a[d];
    if (projects)
      force += trace(stress) / 3. * (mean_gradient(a, q) - of_a);
    return force;
  }


  PERIDEAL_INSTANTIATE_CLASS(class CellProjection);
  PERIDEAL_INSTANTIATE_CLASS(class ProjectedStrains);
} // namespace PeriDeal
