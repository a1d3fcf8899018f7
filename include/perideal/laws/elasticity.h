// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <deal.II/base/symmetric_tensor.h>

#include <perideal/scene/choices.h>
#include <perideal/scene/moduli.h>

namespace PeriDeal
{
  /*
   * Laws of an isotropic elastic body, pure functions of numbers. Moduli are three-dimensional in
   * all dimensions; a body of two dimensions is in plane stress or plane strain and has unit
   * thickness, one of one dimension is a bar of unit cross section that may contract. The plane
   * state is ignored unless dim is 2.
   */

  /**
   * The lambda of sigma = lambda' tr(eps) I + 2 G eps in two dimensions: E nu/(1 - nu^2) = 2 G
   * nu/(1 - nu) in plane stress, which is finite at nu = 1/2; lambda in plane strain.
   */
  double plane_lambda(const Moduli &moduli, const PlaneState plane);

  /** The lambda' of that law in two or three dimensions: plane_lambda() or lambda(). */
  double lambda_of(const Moduli &moduli, const unsigned int dim, const PlaneState plane);


  /**
   * Coefficients of the linear peridynamic solid. With the extension e of the bonds of a node,
   * their lengths x, an influence function omega, q = sum omega x^2 V over the family and the
   * dilatation
   *
   *     theta = dilatation (omega x . e)/q,
   *
   * the scalar force state is
   *
   *     t = omega [ volumetric/q theta x + extension/q e ].
   *
   * A uniform strain then has the energy 1/2 sum t e V of the classical body, to the accuracy with
   * which the family is a full ball: its mean of (n.eps.n)^2 over all directions n is (tr(eps)^2 +
   * 2 eps:eps)/(dim (dim + 2)), hence
   *
   *     dilatation = dim,  volumetric = dim (lambda' - G),  extension = dim (dim + 2) G,
   *
   * with lambda' of lambda_of(): in 2D volumetric = 2 A, A = 2 G nu/(1 - nu) - G in plane stress
   * and K - 5 G/3 in plane strain, extension = 8 G; in 3D 3 K - 5 G and 15 G, which is t = 3 K
   * theta/q omega x + 15 G/q omega (e - theta x/3) (Silling et al. 2007). The form of Le, Chan and
   * Schwartz 2014 in 2D, eqs 2.12 to 2.42 with the x (omega x . e) that eq 2.12 lacks, is the same.
   * In 1D e = eps x, so that theta = eps and W = extension/2 eps^2: extension = E, volumetric = 0.
   */
  struct StateLaw
  {
    double dilatation = 1.;
    double volumetric = 0.;
    double extension  = 0.;
  };

  /** The ordinary state-based law; finite at nu = 1/2 in plane stress and in bars. */
  StateLaw state_law(const Moduli &moduli, const unsigned int dim, const PlaneState plane);

  /**
   * The bond-based law t = extension/q omega e, without a dilatation (volumetric = 0). Its Poisson
   * ratio is bond_based_poisson() whatever the moduli say. Of them it has the stiffness against
   * equal strains in all directions of the dim-dimensional body: extension = dim (dim lambda' + 2
   * G), which is 9 K in 3D, 4 (lambda' + G) in 2D, E in 1D. At its own Poisson ratio it is
   * state_law().
   */
  StateLaw bond_law(const Moduli &moduli, const unsigned int dim, const PlaneState plane);

  /** 1/4, in plane stress 1/3. In 1D a bar stretches by E alone, any ratio will do: 0. */
  double bond_based_poisson(const unsigned int dim, const PlaneState plane);


  /**
   * What a temperature change strains a free body by within its plane, over alpha dT: 1, or 1 + nu
   * in plane strain, where the body cannot extend out of it. Bonds have the extension e - factor
   * alpha dT x.
   */
  double thermal_strain_factor(const Moduli      &moduli,
                               const unsigned int dim,
                               const PlaneState   plane);

  /**
   * sigma = lambda' tr(eps') I + 2 G eps' with eps' = eps - factor alpha dT I; in 1D E (eps - alpha
   * dT).
   *
   * @param thermal_strain alpha dT, without the factor
   */
  template <int dim>
  dealii::SymmetricTensor<2, dim> stress(const Moduli                          &moduli,
                                         const PlaneState                       plane,
                                         const dealii::SymmetricTensor<2, dim> &strain,
                                         const double thermal_strain = 0.);

  /** Out of the plane: nu (sxx + syy) - E alpha dT in plane strain, 0 in plane stress. */
  double stress_zz(const Moduli                        &moduli,
                   const PlaneState                     plane,
                   const dealii::SymmetricTensor<2, 2> &stress,
                   const double                         thermal_strain = 0.);

  /**
   * sqrt(3/2 s:s) with s the deviator of the three-dimensional stress.
   *
   * @param szz stress out of the plane, in two dimensions only. Bars are under uniaxial stress.
   */
  template <int dim>
  double von_mises(const dealii::SymmetricTensor<2, dim> &stress, const double szz = 0.);

  /** Minus a third of the trace of the three-dimensional stress. */
  template <int dim>
  double pressure(const dealii::SymmetricTensor<2, dim> &stress, const double szz = 0.);


  /**
   * Stretch at which bonds of bond_law() with the influence function omega = 1/r (a constant
   * micromodulus) break, such that a unit area of new crack costs the fracture energy. The bonds
   * across it, each with the energy t e = extension/q r s^2, have stored
   *
   *     G_0 = integral over half the ball of (t e) xi_n dV
   *         = s^2 extension delta times 1/3, 3/(4 pi), 1/5  in 1D, 2D, 3D.
   *
   * At the Poisson ratio of the model these are sqrt(5 G_0/(9 K delta)) in 3D, sqrt(4 pi G_0/(9 E
   * delta)) in plane stress, sqrt(5 pi G_0/(12 E delta)) in plane strain, sqrt(3 G_0/(E delta)) in
   * a bar.
   *
   * @param fracture_energy G_0 > 0 per area (2D: per length and unit thickness)
   */
  double critical_stretch_constant(const double       fracture_energy,
                                   const Moduli      &moduli,
                                   const double       delta,
                                   const unsigned int dim,
                                   const PlaneState   plane);


  /**
   * The largest k such that bonds can carry the part k (dd + dd + dd) of the stiffness, d the
   * Kronecker symbols, which is that of lambda' = G = k, and the remainder, with lambda' - k and
   * G - k, still is positive semidefinite: min(G, (lambda' + G)/2) in 2D,
   * min(G, (3 lambda + 2 G)/5) in 3D; in 1D E/3, all of it.
   */
  double bond_part(const Moduli &moduli, const unsigned int dim, const PlaneState plane);
} // namespace PeriDeal
