// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/laws/linear_stress.h>
#include <perideal/laws/nodal_stiffness.h>
#include <perideal/operators/coupling/nodal_family.h>
#include <perideal/scene/orthotropy.h>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  StressLaw::Tangent linear_stiffness(const BodyParameters<dim> &body,
                                      const Point<dim>          &p,
                                      const double               temperature)
  {
    const StressState                kind       = stress_state_of(dim, body.elasticity.plane);
    const Material::Law::Orthotropy &orthotropy = body.material.law.orthotropy;
    if (orthotropy.young.empty())
      return isotropic_stiffness(body.material.moduli(p, temperature), kind);
    const StressLaw::Tangent C = orthotropic_stiffness(orthotropy, p);
    return kind == StressState::plane_stress ? in_plane_stress(C) : C;
  }


  template <int dim>
  NodalFamily<dim>::NodalFamily(const BodyParameters<dim> &body, const Point<dim> &p)
    : stiffness(in_body<dim>(linear_stiffness(body,
                                              p,
                                              body.elasticity.reference_temperature +
                                                body.elasticity.temperature_change.value(p))))
    , shear(soft_shear(stiffness))
  {}


  template <int dim>
  void NodalFamily<dim>::add_to(Family                  &family,
                                const std::vector<Bond> &bonds,
                                const double             volume,
                                const double             strain,
                                const double             share) const
  {
    SymmetricTensor<2, dim>     shape;
    std::vector<Tensor<1, dim>> a(bonds.size() + 1), b;
    std::vector<double>         weights(bonds.size() + 1, 0.);
    for (unsigned int k = 1; k < a.size(); ++k)
      {
        a[k]       = bonds[k - 1].moment;
        weights[k] = bonds[k - 1].weight;
        a[0] -= a[k];
        weights[0] += weights[k];
        shape += symmetrize(outer_product(a[k], a[k])) / weights[k];
      }
    const SymmetricTensor<2, dim> inverse = invert(shape),
                                  stress  = stiffness * unit_symmetric_tensor<dim>();
    const double c = share * stabilizer<dim>(shear, trace(shape) / volume), V = share * volume;
    for (const Tensor<1, dim> &moment : a)
      b.push_back(inverse * moment);
    for (unsigned int k = 0; k < a.size(); ++k)
      {
        const Tensor<1, dim> load = V * strain * (stress * b[k]);
        Tensor<3, dim>       pull; // V b_k . C
        for (unsigned int d = 0; d < dim; ++d)
          for (unsigned int p = 0; p < dim; ++p)
            for (unsigned int e = 0; e < dim; ++e)
              for (unsigned int q = 0; q < dim; ++q)
                pull[d][e][q] += V * b[k][p] * stiffness[d][p][e][q];
        for (unsigned int d = 0; d < dim; ++d)
          family.thermal(dim * k + d) += load[d];
        for (unsigned int l = 0; l < a.size(); ++l)
          {
            const double of_bonds = k == l           ? weights[k] :
                                    k == 0 || l == 0 ? -weights[k + l] :
                                                       0.,
                         beside   = c * (of_bonds - a[k] * b[l]);
            for (unsigned int d = 0; d < dim; ++d)
              {
                family.stiffness(dim * k + d, dim * l + d) += beside;
                for (unsigned int e = 0; e < dim; ++e)
                  family.stiffness(dim * k + d, dim * l + e) += pull[d][e] * b[l];
              }
          }
      }
    family.thermal_energy += 0.5 * V * strain * strain * trace(stress);
  }


  PERIDEAL_INSTANTIATE_FUNCTION(linear_stiffness);
  PERIDEAL_INSTANTIATE_CLASS(class NodalFamily);
} // namespace PeriDeal
