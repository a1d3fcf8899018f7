// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "flux_basis.h"

#include <perideal/base/instantiate.h>

#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    unsigned int power_of(const unsigned int n, const unsigned int exponent)
    {
      return exponent == 0 ? 1 : n * power_of(n, exponent - 1);
    }


    /** Number of a product whose factors are some of the given ones, the first fastest. */
    template <int dim>
    unsigned int product_number(const std::array<unsigned int, dim> &factors, const unsigned int n)
    {
      unsigned int number = 0;
      for (unsigned int d = dim; d-- > 0;)
        number = number * n + factors[d];
      return number;
    }


    /** All choices of factors across a direction, whose own is 0. */
    template <int dim>
    std::vector<std::array<unsigned int, dim>> factors_across(const unsigned int direction,
                                                              const unsigned int n)
    {
      std::vector<std::array<unsigned int, dim>> list;
      for (unsigned int i = 0; i < power_of(n, dim - 1); ++i)
        {
          std::array<unsigned int, dim> factors{};
          unsigned int                  rest = i;
          for (unsigned int d = 0; d < dim; ++d)
            if (d != direction)
              {
                factors[d] = rest % n;
                rest /= n;
              }
          list.push_back(factors);
        }
      return list;
    }
  } // namespace


  std::vector<double> legendre_polynomials(const unsigned int n, const double x)
  {
    const double        t = 2. * x - 1.;
    std::vector<double> p(n, 1.);
    if (n > 1)
      p[1] = t;
    for (unsigned int j = 2; j < n; ++j)
      p[j] = ((2. * j - 1.) * t * p[j - 1] - (j - 1.) * p[j - 2]) / j;
    for (unsigned int j = 0; j < n; ++j)
      p[j] *= std::sqrt(2. * j + 1.);
    return p;
  }


  Eigen::VectorXd legendre_products(const unsigned int n, const std::vector<double> &point)
  {
    Eigen::VectorXd products = Eigen::VectorXd::Ones(1);
    for (const double x : point)
      {
        const std::vector<double> p = legendre_polynomials(n, x);
        Eigen::VectorXd           next(products.size() * n);
        for (unsigned int j = 0; j < n; ++j)
          next.segment(j * products.size(), products.size()) = p[j] * products;
        products = next;
      }
    return products;
  }


  template <int dim>
  FluxBasis<dim>::FluxBasis(const unsigned int k)
    : k(k)
    , n_of_face(power_of(k + 1, dim - 1))
    , n_of_faces(2 * dim * n_of_face)
    , n_divergence(power_of(k + 1, dim))
    , n(n_of_faces + dim * k * n_of_face)
  {
    for (unsigned int f = 0; f < 2 * dim; ++f)
      for (const auto &across : factors_across<dim>(f / 2, k + 1))
        {
          factors.push_back({static_cast<int>(f % 2), across});
          direction.push_back(f / 2);
          divergence.push_back(product_number<dim>(across, k + 1));
        }
    for (unsigned int d = 0; d < dim; ++d)
      for (unsigned int j = 1; j <= k; ++j)
        for (auto across : factors_across<dim>(d, k + 1))
          {
            factors.push_back({static_cast<int>(j + 1), across});
            direction.push_back(d);
            across[d] = j;
            divergence.push_back(product_number<dim>(across, k + 1));
          }
    std::vector<int> first(n_divergence, -1);
    std::vector<int> free_ones;
    for (unsigned int i = n_of_faces; i < n; ++i)
      if (first[divergence[i]] < 0)
        first[divergence[i]] = i;
      else
        free_ones.push_back(i);
    from_faces      = Eigen::MatrixXd::Zero(n, n_of_faces);
    from_divergence = Eigen::MatrixXd::Zero(n, n_divergence);
    free            = Eigen::MatrixXd::Zero(n, free_ones.size());
    for (unsigned int i = 0; i < n_of_faces; ++i)
      {
        from_faces(i, i) = 1.;
        if (divergence[i] > 0)
          from_faces(first[divergence[i]], i) = -1.;
      }
    for (unsigned int m = 1; m < n_divergence; ++m)
      from_divergence(first[m], m) = 1.;
    for (unsigned int y = 0; y < free_ones.size(); ++y)
      {
        free(free_ones[y], y)                    = 1.;
        free(first[divergence[free_ones[y]]], y) = -1.;
      }
  }


  template <int dim>
  Eigen::VectorXd FluxBasis<dim>::values(const Point<dim> &p) const
  {
    std::array<std::vector<double>, dim> polynomials;
    for (unsigned int d = 0; d < dim; ++d)
      polynomials[d] = legendre_polynomials(k + 2, p[d]);
    Eigen::VectorXd result(n);
    for (unsigned int i = 0; i < n; ++i)
      {
        const unsigned int d     = direction[i];
        const int          along = factors[i].along;
        if (along == 0)
          result[i] = p[d] - 1.;
        else if (along == 1)
          result[i] = p[d];
        else
          {
            // The integral of the Legendre polynomial of degree j from 0 on.
            const unsigned int j = along - 1;
            const auto        &P = polynomials[d];
            result[i]            = 0.5 / std::sqrt(2. * j + 1.) *
                        (P[j + 1] / std::sqrt(2. * j + 3.) - P[j - 1] / std::sqrt(2. * j - 1.));
          }
        for (unsigned int e = 0; e < dim; ++e)
          if (e != d)
            result[i] *= polynomials[e][factors[i].across[e]];
      }
    return result;
  }


  template <int dim>
  CondensedCell::CondensedCell(const FluxBasis<dim> &basis, const Eigen::MatrixXd &mass)
  {
    const Eigen::MatrixXd &Z = basis.free;
    by_loads                 = Eigen::MatrixXd::Zero(basis.n, basis.n);
    Eigen::MatrixXd project  = Eigen::MatrixXd::Identity(basis.n, basis.n);
    if (Z.cols() > 0)
      {
        const Eigen::MatrixXd of_free = Z.transpose() * mass;
        by_loads                      = Z * (of_free * Z).llt().solve(Z.transpose());
        project -= by_loads * mass;
      }
    by_faces      = project * basis.from_faces;
    by_divergence = project * basis.from_divergence;
    mixed         = by_faces.transpose() * (mass * basis.from_divergence);
    stiffness     = basis.from_faces.transpose() * (mass * by_faces);
  }


  PERIDEAL_INSTANTIATE_CLASS(struct FluxBasis);

#define INSTANTIATE(dim) \
  template CondensedCell::CondensedCell(const FluxBasis<dim> &, const Eigen::MatrixXd &);
  PERIDEAL_FOR_EACH_DIM(INSTANTIATE)
#undef INSTANTIATE
} // namespace PeriDeal
