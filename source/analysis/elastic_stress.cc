// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/analysis/elastic_stress.h>
#include <perideal/laws/elasticity.h>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  SymmetricTensor<2, 3> full_stress(const SymmetricTensor<2, dim> &stress,
                                    const Scene<dim>              &scene,
                                    const Point<dim>              &p,
                                    const double                   temperature_change)
  {
    SymmetricTensor<2, 3> full;
    for (unsigned int a = 0; a < dim; ++a)
      for (unsigned int b = a; b < dim; ++b)
        full[a][b] = stress[a][b];
    if constexpr (dim == 2)
      full[2][2] = stress_zz(scene.material.moduli(p),
                             scene.elasticity.plane,
                             stress,
                             scene.material.thermal_expansion.value(p) * temperature_change);
    return full;
  }


  template <int dim>
  SymmetricTensor<2, 3> stress_of_strain(const SymmetricTensor<2, dim> &strain,
                                         const Scene<dim>              &scene,
                                         const Point<dim>              &p,
                                         const double                   temperature_change)
  {
    return full_stress(stress(scene.material.moduli(p),
                              scene.elasticity.plane,
                              strain,
                              scene.material.thermal_expansion.value(p) * temperature_change),
                       scene,
                       p,
                       temperature_change);
  }


#define PERIDEAL_INSTANTIATE(dim)                                                  \
  template SymmetricTensor<2, 3> full_stress(const SymmetricTensor<2, dim> &,      \
                                             const Scene<dim> &,                   \
                                             const Point<dim> &,                   \
                                             const double);                        \
  template SymmetricTensor<2, 3> stress_of_strain(const SymmetricTensor<2, dim> &, \
                                                  const Scene<dim> &,              \
                                                  const Point<dim> &,              \
                                                  const double);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
