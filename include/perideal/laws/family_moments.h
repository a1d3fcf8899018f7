// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/tensor.h>

#include <array>
#include <vector>

namespace PeriDeal
{
  /** Independent fourth moments in dim dimensions. */
  template <int dim>
  constexpr unsigned int n_fourth_moments = dim == 1 ? 1 : (dim == 2 ? 5 : 15);

  template <int dim>
  using FourthMoments = std::array<double, n_fourth_moments<dim>>;

  /**
   * All products n_a n_b n_c n_d of the components of the direction n = xi/x, each times the square
   * root of how often it occurs in the tensor n n n n. They are the same for xi and -xi. The
   * squares of their components add up to 1.
   *
   * With weights w of bonds, sum w x^2 n n n n over a family is all that its energy and collapsed
   * stress under a uniform strain know of it: the trace over two of the indices is sum w xi xi,
   * from which theta comes, the trace over all q.
   */
  template <int dim>
  FourthMoments<dim> fourth_moments(const dealii::Tensor<1, dim> &xi);

  /** The mean of these over all directions: (dd + dd + dd)/(dim (dim + 2)). */
  template <int dim>
  FourthMoments<dim> isotropic_fourth_moments();


  /**
   * A symmetric positive definite matrix sum w m m^T and its Cholesky factor, row by row below the
   * diagonal.
   */
  template <int dim>
  class MomentMatrix
  {
  public:
    void add(const FourthMoments<dim> &m, const double w);

    /** False if it is singular: the bonds have too few directions. Then it must not be used. */
    bool factorize();

    FourthMoments<dim> solve(const FourthMoments<dim> &right_side) const;

  private:
    static constexpr unsigned int      n = n_fourth_moments<dim>;
    std::array<double, n *(n + 1) / 2> entries{};
  };

  template <int dim>
  double scalar_product(const FourthMoments<dim> &a, const FourthMoments<dim> &b);

  /**
   * The y for which the factors 1 + y . m of a family's bonds, of all factors those nearest to 1 in
   * the mean of w, add sum w m (y . m) = missing; and whether all these factors are positive.
   */
  template <int dim>
  bool positive_factors_exist(const std::vector<FourthMoments<dim>> &m,
                              const MomentMatrix<dim>               &factorized,
                              const FourthMoments<dim>              &missing);
} // namespace PeriDeal
