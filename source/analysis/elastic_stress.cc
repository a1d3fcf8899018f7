// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/analysis/elastic_stress.h>
#include <perideal/base/instantiate.h>
#include <perideal/laws/elasticity.h>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  SymmetricTensor<2, 3> full_stress(const SymmetricTensor<2, dim> &stress,
                                    const BodyParameters<dim>     &body,
                                    const Point<dim>              &p,
                                    const double                   temperature_change)
  {
    SymmetricTensor<2, 3> full;
    for (unsigned int a = 0; a < dim; ++a)
      for (unsigned int b = a; b < dim; ++b)
        full[a][b] = stress[a][b];
    if constexpr (dim == 2)
      full[2][2] = stress_zz(body.moduli(p, temperature_change),
                             body.elasticity.plane,
                             stress,
                             body.free_expansion(p, temperature_change));
    return full;
  }


  template <int dim>
  SymmetricTensor<2, 3> stress_of_strain(const SymmetricTensor<2, dim> &strain,
                                         const BodyParameters<dim>     &body,
                                         const Point<dim>              &p,
                                         const double                   temperature_change)
  {
    return full_stress(stress(body.moduli(p, temperature_change),
                              body.elasticity.plane,
                              strain,
                              body.free_expansion(p, temperature_change)),
                       body,
                       p,
                       temperature_change);
  }


  template <int dim>
  SymmetricTensor<2, 3> shear_stress(const SymmetricTensor<2, dim> &strain,
                                     const BodyParameters<dim>     &body,
                                     const Point<dim>              &p)
  {
    SymmetricTensor<2, 3> full;
    for (unsigned int a = 0; a < dim; ++a)
      for (unsigned int b = a; b < dim; ++b)
        full[a][b] = strain[a][b];
    return 2. * body.moduli(p).shear * deviator(full);
  }


  PERIDEAL_INSTANTIATE_FUNCTION(full_stress);
  PERIDEAL_INSTANTIATE_FUNCTION(stress_of_strain);
  PERIDEAL_INSTANTIATE_FUNCTION(shear_stress);
} // namespace PeriDeal
