// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/operators/solid/deformed_strains.h>

#include <algorithm>
#include <cmath>

#include "large_deformation.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** det(1 + G) - 1, with the digits of small gradients. */
    template <int dim>
    double change_of_volume(const Tensor<2, dim> &G)
    {
      if constexpr (dim == 1)
        return G[0][0];
      else if constexpr (dim == 2)
        return trace(G) + determinant(G);
      else
        {
          const double t = trace(G);
          return t + 0.5 * (t * t - trace(G * G)) + determinant(G);
        }
    }


    template <int dim>
    Tensor<1, dim> stress_along(const SymmetricTensor<2, 3> &stress, const Tensor<1, dim> &vector)
    {
      Tensor<1, dim> product;
      for (unsigned int c = 0; c < dim; ++c)
        for (unsigned int d = 0; d < dim; ++d)
          product[c] += stress[c][d] * vector[d];
      return product;
    }


    /** What a pressure in the deformed body does along with a stress: S : C_bar/3. */
    double mean_of(const SymmetricTensor<2, 3> &stress, const SymmetricTensor<2, 3> &strain)
    {
      return (trace(stress) + 2. * (stress * strain)) / 3.;
    }
  } // namespace


  template <int dim>
  DeformedStrains<dim>::DeformedStrains(const FiniteElement<dim> &fe,
                                        const unsigned int        n_points,
                                        const bool                projects)
    : projects(projects)
    , projection(fe, n_points)
    , points(n_points)
    , slopes(n_points * fe.n_dofs_per_cell())
    , means(projects ? slopes.size() : 0)
  {}


  template <int dim>
  void DeformedStrains<dim>::reinit(const FEValues<dim>          &of_cell,
                                    const dealii::Vector<double> &u,
                                    const bool                    with_slopes)
  {
    values = &of_cell;
    for (unsigned int q = 0; q < points.size(); ++q)
      {
        Deformed &at = points[q];
        at           = Deformed();
        for (unsigned int a = 0; a < of_cell.dofs_per_cell; ++a)
          for (unsigned int d = 0; d < dim; ++d)
            at.gradient[d] += u(dim * a + d) * of_cell.shape_grad(a, q);
        at.change = at.mean = change_of_volume<dim>(at.gradient);
        if (projects && at.change > -1.)
          at.inverse = invert(deformation_of(at.gradient));
        at.strain = in_space(strain_of(at.gradient));
      }
    if (!projects)
      return;
    projection.reinit(of_cell);
    std::vector<double> projected;
    projection.find(projected, [&](const unsigned int q) { return points[q].change; });
    for (unsigned int q = 0; q < points.size(); ++q)
      {
        Deformed &at = points[q];
        at.mean      = projected[q];
        if (!(volume_ratio(q) > 0.))
          continue;
        at.log_size = 2. / 3. * (std::log1p(at.mean) - std::log1p(at.change));
        at.strain   = std::exp(at.log_size) * at.strain +
                    0.5 * std::expm1(at.log_size) * unit_symmetric_tensor<3>();
      }
    if (with_slopes)
      find_slopes();
  }


  template <int dim>
  void DeformedStrains<dim>::find_slopes()
  {
    std::vector<Vector> projected;
    for (unsigned int a = 0; a < values->dofs_per_cell; ++a)
      {
        for (unsigned int q = 0; q < points.size(); ++q)
          slopes[place(a, q)] = transpose(points[q].inverse) * values->shape_grad(a, q);
        projection.find(projected, [&](const unsigned int q) {
          return (1. + points[q].change) * slopes[place(a, q)];
        });
        for (unsigned int q = 0; q < points.size(); ++q)
          means[place(a, q)] = projected[q] / (1. + points[q].mean);
      }
  }


  template <int dim>
  double DeformedStrains<dim>::volume_ratio(const unsigned int q) const
  {
    return 1. + std::min(points[q].change, points[q].mean);
  }


  template <int dim>
  Tensor<2, 3> DeformedStrains<dim>::displacement_gradient(const unsigned int q) const
  {
    const double half_log = 0.5 * points[q].log_size;
    return std::exp(half_log) * in_space(points[q].gradient) +
           std::expm1(half_log) * Tensor<2, 3>(unit_symmetric_tensor<3>());
  }


  template <int dim>
  SymmetricTensor<2, 3> DeformedStrains<dim>::of_unknown(const unsigned int a,
                                                         const unsigned int d,
                                                         const unsigned int q) const
  {
    const Vector &of_a = values->shape_grad(a, q);
    const Vector  row  = deformation_of(points[q].gradient)[d];
    const double  size = std::exp(points[q].log_size);
    Strain        full;
    for (unsigned int c = 0; c < dim; ++c)
      for (unsigned int e = c; e < dim; ++e)
        full[c][e] = 0.5 * size * (row[c] * of_a[e] + row[e] * of_a[c]);
    if (projects)
      full += (means[place(a, q)][d] - slopes[place(a, q)][d]) / 3. *
              (unit_symmetric_tensor<3>() + 2. * strain(q));
    return full;
  }


  // What a pressure is projected with is its own transpose, so that it may take the pressures.
  template <int dim>
  void DeformedStrains<dim>::find_nominal(std::vector<Tensor<2, dim>> &nominal,
                                          const std::vector<Strain>   &stresses) const
  {
    std::vector<double> projected;
    if (projects)
      projection.find(projected, [&](const unsigned int q) {
        return mean_of(stresses[q], strain(q)) / (1. + points[q].mean);
      });
    nominal.resize(points.size());
    for (unsigned int q = 0; q < points.size(); ++q)
      {
        const Deformed         &at = points[q];
        SymmetricTensor<2, dim> stress;
        for (unsigned int c = 0; c < dim; ++c)
          for (unsigned int d = c; d < dim; ++d)
            stress[c][d] = stresses[q][c][d];
        nominal[q] = std::exp(at.log_size) * (deformation_of(at.gradient) * Tensor<2, dim>(stress));
        if (projects)
          nominal[q] += ((1. + at.change) * projected[q] - mean_of(stresses[q], strain(q))) *
                        transpose(at.inverse);
      }
  }


  /*
   * With k the change of ln (J_bar/J), m that of ln J_bar, h that of ln J, s = (J_bar/J)^(2/3), p =
   * S : C_bar/3, and unknowns (a, d) and (b, e):
   *
   *   s d_de grad_a . S grad_b + 2/3 s (k_a (F S grad_b) + (F S grad_a) k_b)
   *   + p (2/3 k_a k_b - m_a m_b + h_a[e] h_b[d])
   *   + p/J_bar (J (h_a h_b - h_a[e] h_b[d])) projected;
   *
   * what is projected last is p/J_bar, which comes to the same.
   */
  template <int dim>
  void DeformedStrains<dim>::add_geometric(FullMatrix<double>        &matrix,
                                           const std::vector<Strain> &stresses) const
  {
    const unsigned int     n = values->dofs_per_cell;
    std::vector<double>    pressures(points.size(), 0.), projected;
    std::vector<Geometric> nodes(n);
    for (unsigned int q = 0; projects && q < points.size(); ++q)
      pressures[q] = mean_of(stresses[q], strain(q));
    if (projects)
      projection.find(projected, [&](const unsigned int q) {
        return pressures[q] / (values->JxW(q) * (1. + points[q].mean));
      });
    for (unsigned int q = 0; q < points.size(); ++q)
      {
        const double size = std::exp(points[q].log_size), p = pressures[q],
                     of_all = projects ? projected[q] * values->JxW(q) * (1. + points[q].change) :
                                         0.;
        for (unsigned int a = 0; a < n; ++a)
          {
            nodes[a].of_stress = size * stress_along<dim>(stresses[q], values->shape_grad(a, q));
            nodes[a].along     = deformation_of(points[q].gradient) * nodes[a].of_stress;
            if (projects)
              nodes[a].beside = means[place(a, q)] - slopes[place(a, q)];
          }
        for (unsigned int a = 0; a < n; ++a)
          for (unsigned int b = 0; b < n; ++b)
            {
              const double of_both = nodes[b].of_stress * values->shape_grad(a, q);
              for (unsigned int d = 0; d < dim; ++d)
                matrix(dim * a + d, dim * b + d) += of_both;
              if (!projects)
                continue;
              const Vector &h_a = slopes[place(a, q)], &h_b = slopes[place(b, q)],
                           &m_a = means[place(a, q)], &m_b = means[place(b, q)],
                           &k_a = nodes[a].beside, &k_b = nodes[b].beside;
              for (unsigned int d = 0; d < dim; ++d)
                for (unsigned int e = 0; e < dim; ++e)
                  matrix(dim * a + d, dim * b + e) +=
                    2. / 3. * (k_a[d] * nodes[b].along[e] + nodes[a].along[d] * k_b[e]) +
                    p * (2. / 3. * k_a[d] * k_b[e] - m_a[d] * m_b[e] + h_a[e] * h_b[d]) +
                    of_all * (h_a[d] * h_b[e] - h_a[e] * h_b[d]);
            }
      }
  }


  template <int dim>
  SymmetricTensor<2, 3> DeformedStrains<dim>::cauchy(const unsigned int         q,
                                                     const StressLaw::Response &response) const
  {
    const Deformed &at = points[q];
    return std::exp(at.log_size) * (1. + at.change) / (1. + at.mean) *
           cauchy_stress(at.gradient, response);
  }


  template <int dim>
  double DeformedStrains<dim>::stiffening(const unsigned int q) const
  {
    return stiffening_of(strain_of(points[q].gradient));
  }


  PERIDEAL_INSTANTIATE_CLASS(class DeformedStrains);
} // namespace PeriDeal
