// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/operators/solid/correspondence.h>

#include "family_sums.h"

namespace PeriDeal
{
  template <int dim>
  void write(double *numbers, const dealii::Tensor<2, dim> &tensor)
  {
    for (unsigned int a = 0; a < dim; ++a)
      for (unsigned int b = 0; b < dim; ++b)
        numbers[dim * a + b] = tensor[a][b];
  }


  template <int dim>
  inline dealii::Tensor<1, dim> times(const double *numbers, const dealii::Tensor<1, dim> &vector)
  {
    dealii::Tensor<1, dim> product;
    for (unsigned int a = 0; a < dim; ++a)
      {
        double sum = numbers[dim * a] * vector[0];
        for (unsigned int b = 1; b < dim; ++b)
          sum += numbers[dim * a + b] * vector[b];
        product[a] = sum;
      }
    return product;
  }


  template <int dim>
  inline dealii::Tensor<1, dim> vector_at(const double *numbers)
  {
    dealii::Tensor<1, dim> vector;
    for (unsigned int a = 0; a < dim; ++a)
      vector[a] = numbers[a];
    return vector;
  }


  /** Add du (W xi)^T. */
  template <int dim>
  inline void add_change(dealii::Tensor<2, dim>       &sum,
                         const dealii::Tensor<1, dim> &change,
                         const dealii::Tensor<1, dim> &moment)
  {
    for (unsigned int a = 0; a < dim; ++a)
      for (unsigned int b = 0; b < dim; ++b)
        sum[a][b] += change[a] * moment[b];
  }


  /** visit(rows, k) of a family. */
  template <int dim, typename Visit>
  void for_each_bond(const BondTable<dim> &bonds,
                     const Span           &inside,
                     const Span           &outside,
                     const Visit          &visit)
  {
    for (std::size_t k = inside.begin; k < inside.end; ++k)
      visit(bonds.body, k);
    for (std::size_t k = outside.begin; k < outside.end; ++k)
      visit(bonds.beyond, k);
  }


  /** The sum of du (W xi)^T over the family of a node. */
  template <int dim>
  dealii::Tensor<2, dim> sum_of_changes(const BondTable<dim> &bonds,
                                        const BondEnds<dim>  &ends,
                                        const double         *u,
                                        const unsigned int    i,
                                        const Span           &inside,
                                        const Span           &outside)
  {
    dealii::Tensor<2, dim> sum;
    for_each_bond(bonds, inside, outside, [&](const BondRows<dim> &rows, const std::size_t k) {
      add_change(sum, ends.change(u, i, rows.neighbors[k]), rows.moments[k]);
    });
    return sum;
  }


  /** Of a node: of W |z_e|^2 and of W z_e . du. */
  struct ElasticSums
  {
    double squares = 0., products = 0.;
  };


  /** Add some of its bonds, which remember something where the law flows. */
  template <int dim>
  void add_elastic(ElasticSums                  &sums,
                   const NodeShapes<dim>        &shapes,
                   const BondTable<dim>         &bonds,
                   const BondEnds<dim>          &ends,
                   const double                 *u,
                   const unsigned int            i,
                   const dealii::Tensor<2, dim> &slopes,
                   const bool                    flows,
                   const Span                   &inside,
                   const Span                   &outside)
  {
    constexpr unsigned int n_history = Correspondence<dim>::n_history;
    for_each_bond(bonds, inside, outside, [&](const BondRows<dim> &rows, const std::size_t k) {
      const double w = shapes.weights().of(&rows == &bonds.beyond)[k];
      if (w == 0.)
        return;
      const dealii::Tensor<1, dim> change = ends.change(u, i, rows.neighbors[k]);
      dealii::Tensor<1, dim>       beside = change - slopes * rows.moments[k] / w;
      if (flows)
        beside -= vector_at<dim>(&rows.nonlinear.history[n_history * k]);
      sums.squares += w * beside.norm_square();
      sums.products += w * (beside * change);
    });
  }
} // namespace PeriDeal
