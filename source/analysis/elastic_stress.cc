// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/analysis/elastic_stress.h>
#include <perideal/laws/elasticity.h>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    double thermal_strain(const Scene<dim> &scene, const Point<dim> &p)
    {
      return scene.material.thermal_expansion.value(p) *
             scene.elasticity.temperature_change.value(p);
    }
  } // namespace


  template <int dim>
  SymmetricTensor<2, 3> full_stress(const SymmetricTensor<2, dim> &stress,
                                    const Scene<dim>              &scene,
                                    const Point<dim>              &p)
  {
    SymmetricTensor<2, 3> full;
    for (unsigned int a = 0; a < dim; ++a)
      for (unsigned int b = a; b < dim; ++b)
        full[a][b] = stress[a][b];
    if constexpr (dim == 2)
      full[2][2] = stress_zz(scene.material.moduli(p),
                             scene.elasticity.plane,
                             stress,
                             thermal_strain(scene, p));
    return full;
  }


  template <int dim>
  SymmetricTensor<2, 3> stress_of_strain(const SymmetricTensor<2, dim> &strain,
                                         const Scene<dim>              &scene,
                                         const Point<dim>              &p)
  {
    return full_stress(
      stress(scene.material.moduli(p), scene.elasticity.plane, strain, thermal_strain(scene, p)),
      scene,
      p);
  }


#define PERIDEAL_INSTANTIATE(dim)                                                  \
  template SymmetricTensor<2, 3> full_stress(const SymmetricTensor<2, dim> &,      \
                                             const Scene<dim> &,                   \
                                             const Point<dim> &);                  \
  template SymmetricTensor<2, 3> stress_of_strain(const SymmetricTensor<2, dim> &, \
                                                  const Scene<dim> &,              \
                                                  const Point<dim> &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
