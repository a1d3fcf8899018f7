// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/laws/family_moments.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** Calls visit(a, b, c, d) for all indices in ascending order, a <= b <= c <= d. */
    template <int dim, typename Visit>
    void for_each_moment(const Visit &visit)
    {
      for (unsigned int a = 0; a < dim; ++a)
        for (unsigned int b = a; b < dim; ++b)
          for (unsigned int c = b; c < dim; ++c)
            for (unsigned int d = c; d < dim; ++d)
              visit(a, b, c, d);
    }


    /**
     * The square roots of how often each of them occurs: 4! over the factorials of the numbers of
     * equal indices.
     */
    template <int dim>
    FourthMoments<dim> roots_of_multiplicity()
    {
      FourthMoments<dim> roots;
      unsigned int       k = 0;
      for_each_moment<dim>([&](const auto a, const auto b, const auto c, const auto d) {
        double       times = 24.;
        unsigned int run   = 1;
        for (const bool equal : {a == b, b == c, c == d})
          {
            run = equal ? run + 1 : 1;
            times /= run;
          }
        roots[k++] = std::sqrt(times);
      });
      return roots;
    }
  } // namespace


  template <int dim>
  FourthMoments<dim> fourth_moments(const Tensor<1, dim> &xi)
  {
    [[maybe_unused]] static const FourthMoments<dim> roots = roots_of_multiplicity<dim>(); // 1D
    const Tensor<1, dim>                             n     = xi / xi.norm();
    FourthMoments<dim>                               m;
    unsigned int                                     k = 0;
    for_each_moment<dim>([&](const auto a, const auto b, const auto c, const auto d) {
      m[k] = roots[k] * n[a] * n[b] * n[c] * n[d];
      ++k;
    });
    return m;
  }


  template <int dim>
  FourthMoments<dim> isotropic_fourth_moments()
  {
    FourthMoments<dim> m;
    unsigned int       k = 0;
    for_each_moment<dim>([&](const auto a, const auto b, const auto c, const auto d) {
      m[k++] = (a == b && c == d) ? (a == d ? 3. : std::sqrt(6.)) / (dim * (dim + 2.)) : 0.;
    });
    return m;
  }


  template <int dim>
  double scalar_product(const FourthMoments<dim> &a, const FourthMoments<dim> &b)
  {
    double sum = 0.;
    for (unsigned int k = 0; k < a.size(); ++k)
      sum += a[k] * b[k];
    return sum;
  }


  template <int dim>
  void MomentMatrix<dim>::add(const FourthMoments<dim> &m, const double w)
  {
    for (unsigned int a = 0, k = 0; a < n; ++a)
      for (unsigned int b = 0; b <= a; ++b, ++k)
        entries[k] += w * m[a] * m[b];
  }


  template <int dim>
  bool MomentMatrix<dim>::factorize()
  {
    double trace = 0.;
    for (unsigned int a = 0; a < n; ++a)
      trace += entries[a * (a + 3) / 2];
    for (unsigned int a = 0; a < n; ++a)
      for (unsigned int b = 0; b <= a; ++b)
        {
          double *const row = &entries[a * (a + 1) / 2], *const other = &entries[b * (b + 1) / 2];
          double value = row[b];
          for (unsigned int c = 0; c < b; ++c)
            value -= row[c] * other[c];
          if (b < a)
            row[b] = value / other[b];
          else if (!(value > 1e-8 * trace))
            return false;
          else
            row[b] = std::sqrt(value);
        }
    return true;
  }


  template <int dim>
  FourthMoments<dim> MomentMatrix<dim>::solve(const FourthMoments<dim> &right_side) const
  {
    FourthMoments<dim> x = right_side;
    for (unsigned int a = 0; a < n; ++a)
      {
        const double *const row = &entries[a * (a + 1) / 2];
        for (unsigned int b = 0; b < a; ++b)
          x[a] -= row[b] * x[b];
        x[a] /= row[a];
      }
    for (unsigned int a = n; a-- > 0;)
      {
        for (unsigned int b = a + 1; b < n; ++b)
          x[a] -= entries[b * (b + 1) / 2 + a] * x[b];
        x[a] /= entries[a * (a + 3) / 2];
      }
    return x;
  }


  template <int dim>
  bool positive_factors_exist(const std::vector<FourthMoments<dim>> &m,
                              const MomentMatrix<dim>               &factorized,
                              const FourthMoments<dim>              &missing)
  {
    const FourthMoments<dim> y = factorized.solve(missing);
    return std::all_of(m.begin(), m.end(), [&](const FourthMoments<dim> &bond) {
      return 1. + scalar_product<dim>(y, bond) > 0.;
    });
  }


  PERIDEAL_INSTANTIATE_FUNCTION(fourth_moments);
  PERIDEAL_INSTANTIATE_FUNCTION(isotropic_fourth_moments);
  PERIDEAL_INSTANTIATE_FUNCTION(scalar_product);
  PERIDEAL_INSTANTIATE_CLASS(class MomentMatrix);
  PERIDEAL_INSTANTIATE_FUNCTION(positive_factors_exist);
} // namespace PeriDeal
