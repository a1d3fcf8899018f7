// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/laws/stretch_energy.h>

#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void StretchSums<dim>::add(const Tensor<1, dim> &xi, const double w)
  {
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double square = xi[d] * xi[d];
        dilatation[d] += w * square;
        energy[d] += w * square * square / xi.norm_square();
      }
  }


  template <int dim>
  Tensor<1, dim> axis_factors(const Tensor<1, dim> &complete, const Tensor<1, dim> &own)
  {
    Tensor<1, dim> factors;
    for (unsigned int d = 0; d < dim; ++d)
      {
        Assert(own[d] > 0., ExcInternalError());
        factors[d] = complete[d] / own[d];
      }
    return factors;
  }


  template <int dim>
  double ellipsoid_factor(const Tensor<1, dim> &one,
                          const Tensor<1, dim> &other,
                          const Tensor<1, dim> &xi)
  {
    double sum = 0.;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double part = 2. * xi[d] / (one[d] + other[d]);
        sum += part * part;
      }
    return xi.norm() / std::sqrt(sum);
  }


  PERIDEAL_INSTANTIATE_CLASS(struct StretchSums);
  PERIDEAL_INSTANTIATE_FUNCTION(axis_factors);
  PERIDEAL_INSTANTIATE_FUNCTION(ellipsoid_factor);
} // namespace PeriDeal
