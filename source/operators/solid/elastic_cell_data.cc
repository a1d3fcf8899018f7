// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "elastic_cell_data.h"

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  void ElasticElements<dim>::CellData::assemble(const ElasticElements &of)
  {
    const unsigned int         n        = indices.size();
    const Vector              &at_nodes = of.temperature_change();
    const BodyParameters<dim> &body     = of.body;
    stiffness                           = 0.;
    thermal                             = 0.;
    mass                                = 0.;
    diagonal                            = 0.;
    volume                              = 0.;
    thermal_energy                      = 0.;
    for (const unsigned int q : values.quadrature_point_indices())
      {
        const Point<dim> &p      = values.quadrature_point(q);
        const double      JxW    = values.JxW(q);
        const Moduli      moduli = body.material.moduli(p);
        // A bar has E alone.
        const double lambda = dim == 1 ? 0. : lambda_of(moduli, dim, body.elasticity.plane),
                     mu     = dim == 1 ? 0.5 * moduli.young() : moduli.shear;
        double change       = 0.; // of the temperature
        if (at_nodes.size() == 0)
          change = body.elasticity.temperature_change.value(p);
        else
          for (unsigned int a = 0; a < n; ++a)
            change += at_nodes(indices[a]) * values.shape_value(a, q);
        const double strain   = of.thermal_strain(p, change);
        const double pressure = (dim * lambda + 2. * mu) * strain;
        const double density  = body.elasticity.is_static() ? 1. : body.material.density.value(p);
        thermal_energy += 0.5 * dim * pressure * strain * JxW;
        for (unsigned int a = 0; a < n; ++a)
          {
            const Tensor<1, dim> &ga = values.shape_grad(a, q);
            volume(a) += values.shape_value(a, q) * JxW;
            mass(a) += density * values.shape_value(a, q) * JxW;
            diagonal(a) += density * values.shape_value(a, q) * values.shape_value(a, q) * JxW;
            for (unsigned int d = 0; d < dim; ++d)
              thermal(dim * a + d) += pressure * ga[d] * JxW;
            for (unsigned int b = 0; b < n; ++b)
              {
                const Tensor<1, dim> &gb      = values.shape_grad(b, q);
                const double          product = mu * (ga * gb) * JxW;
                for (unsigned int d = 0; d < dim; ++d)
                  {
                    stiffness(dim * a + d, dim * b + d) += product;
                    for (unsigned int e = 0; e < dim; ++e)
                      stiffness(dim * a + d, dim * b + e) +=
                        (lambda * ga[d] * gb[e] + mu * ga[e] * gb[d]) * JxW;
                  }
              }
          }
      }
  }


  template <int dim>
  double ElasticElements<dim>::CellData::energy(const Vector &u) const
  {
    double sum = thermal_energy;
    for (unsigned int i = 0; i < unknowns.size(); ++i)
      {
        sum += (0.5 * force(i, u) - thermal(i)) * u(unknowns[i]);
      }
    return sum;
  }


#define PERIDEAL_INSTANTIATE(dim)                                                         \
  template void   ElasticElements<dim>::CellData::assemble(const ElasticElements<dim> &); \
  template double ElasticElements<dim>::CellData::energy(const Vector &) const;
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
