// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/base/instantiate.h>
#include <perideal/laws/elasticity.h>

#include <algorithm>
#include <cmath>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    const double pi = std::acos(-1.);
  }


  double plane_lambda(const Moduli &moduli, const PlaneState plane)
  {
    if (plane == PlaneState::strain)
      return moduli.lambda();
    const double nu = moduli.poisson();
    return 2. * moduli.shear * nu / (1. - nu);
  }


  double lambda_of(const Moduli &moduli, const unsigned int dim, const PlaneState plane)
  {
    Assert(dim == 2 || dim == 3, ExcMessage("A bar has no lambda."));
    return dim == 2 ? plane_lambda(moduli, plane) : moduli.lambda();
  }


  StateLaw state_law(const Moduli &moduli, const unsigned int dim, const PlaneState plane)
  {
    if (dim == 1)
      return {1., 0., moduli.young()};
    return {1. * dim,
            dim * (lambda_of(moduli, dim, plane) - moduli.shear),
            dim * (dim + 2.) * moduli.shear};
  }


  StateLaw bond_law(const Moduli &moduli, const unsigned int dim, const PlaneState plane)
  {
    if (dim == 1)
      return {1., 0., moduli.young()};
    return {1. * dim, 0., dim * (dim * lambda_of(moduli, dim, plane) + 2. * moduli.shear)};
  }


  double bond_based_poisson(const unsigned int dim, const PlaneState plane)
  {
    return dim == 1 ? 0. : dim == 2 && plane == PlaneState::stress ? 1. / 3. : 0.25;
  }


  double thermal_strain_factor(const Moduli &moduli, const unsigned int dim, const PlaneState plane)
  {
    return dim == 2 && plane == PlaneState::strain ? 1. + moduli.poisson() : 1.;
  }


  template <int dim>
  SymmetricTensor<2, dim> stress(const Moduli                  &moduli,
                                 const PlaneState               plane,
                                 const SymmetricTensor<2, dim> &strain,
                                 const double                   thermal_strain)
  {
    const SymmetricTensor<2, dim> elastic = strain - thermal_strain_factor(moduli, dim, plane) *
                                                       thermal_strain *
                                                       unit_symmetric_tensor<dim>();
    if (dim == 1)
      return moduli.young() * elastic;
    return lambda_of(moduli, dim, plane) * trace(elastic) * unit_symmetric_tensor<dim>() +
           2. * moduli.shear * elastic;
  }


  double stress_zz(const Moduli                &moduli,
                   const PlaneState             plane,
                   const SymmetricTensor<2, 2> &stress,
                   const double                 thermal_strain)
  {
    if (plane == PlaneState::stress)
      return 0.;
    return moduli.poisson() * trace(stress) - moduli.young() * thermal_strain;
  }


  namespace
  {
    template <int dim>
    double full_trace(const SymmetricTensor<2, dim> &stress, const double szz)
    {
      Assert(dim == 2 || szz == 0., ExcMessage("szz is for two dimensions."));
      return trace(stress) + szz;
    }
  } // namespace


  template <int dim>
  double von_mises(const SymmetricTensor<2, dim> &stress, const double szz)
  {
    // the squares of the deviator, one by one: no cancellation under high pressure
    const double mean   = full_trace(stress, szz) / 3.;
    double       square = 0.;
    for (unsigned int i = 0; i < 3; ++i)
      {
        const double normal = i < dim ? stress[i % dim][i % dim] : i == 2 ? szz : 0.;
        square += (normal - mean) * (normal - mean);
        for (unsigned int j = i + 1; j < dim; ++j)
          square += 2. * stress[i % dim][j % dim] * stress[i % dim][j % dim];
      }
    return std::sqrt(1.5 * square);
  }


  template <int dim>
  double pressure(const SymmetricTensor<2, dim> &stress, const double szz)
  {
    return -full_trace(stress, szz) / 3.;
  }


  double critical_stretch_constant(const double       fracture_energy,
                                   const Moduli      &moduli,
                                   const double       delta,
                                   const unsigned int dim,
                                   const PlaneState   plane)
  {
    Assert(dim >= 1 && dim <= 3, ExcMessage("There are one to three dimensions."));
    const double share = dim == 1 ? 1. / 3. : dim == 2 ? 0.75 / pi : 0.2;
    return std::sqrt(fracture_energy / (share * bond_law(moduli, dim, plane).extension * delta));
  }


  double bond_part(const Moduli &moduli, const unsigned int dim, const PlaneState plane)
  {
    if (dim == 1)
      return moduli.young() / 3.;
    // The eigenvalues of the remainder are 2 (G - k), and for equal strains dim lambda' + 2 G -
    // (dim + 2) k.
    const double equal = dim * lambda_of(moduli, dim, plane) + 2. * moduli.shear;
    return std::min(moduli.shear, equal / (dim + 2.));
  }


  PERIDEAL_INSTANTIATE_FUNCTION(stress);
  PERIDEAL_INSTANTIATE_FUNCTION(von_mises);
  PERIDEAL_INSTANTIATE_FUNCTION(pressure);
} // namespace PeriDeal
