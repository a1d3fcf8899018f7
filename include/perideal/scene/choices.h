// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

/**
 * @file
 * The choices of a scene file that pure laws also take: enumerations and
 * nothing else, so that the laws need no parameter handler.
 */

namespace PeriDeal
{
  enum class KernelShape
  {
    constant,
    conical,
    gaussian
  };

  enum class VolumeFraction
  {
    none,
    linear,
    exact
  };

  enum class Calibration
  {
    discrete,
    isotropic,
    analytic
  };

  enum class SelfTerm
  {
    none,
    paper
  };

  enum class NodalVolume
  {
    partial,
    full
  };

  enum class BoundaryTreatment
  {
    automatic,
    exchange,
    none,
    layer,
    fictitious_mirror,
    fictitious_constant
  };

  enum class FluxTreatment
  {
    natural,
    extrapolation,
    layer_extrapolation
  };

  enum class SurfaceCorrection
  {
    none,
    crack_scaling,
    energy,
    moments, // this and the next: elasticity
    fictitious_nodes,
    automatic // elasticity; diffusion has none
  };

  enum class CorrectionDirection
  {
    x,
    y,
    z,
    both
  };

  enum class OperatorForm
  {
    automatic,
    lattice,
    stored
  };

  /** Bonds whose way leads through a hole or an empty part of an image. */
  enum class BondsAcrossVoids
  {
    automatic, // cut with exchange, else kept
    keep,
    cut
  };

  enum class InterfaceRule
  {
    minimum,
    arithmetic,
    harmonic
  };

  enum class PlaneState
  {
    stress,
    strain
  };

  /** Strains of the undeformed or of the deformed bonds. */
  enum class Kinematics
  {
    linear,
    full
  };

  enum class ElasticModel
  {
    state_based,
    bond_based,
    correspondence
  };

  /** How forces follow from what the body has gone through. */
  enum class SolidLaw
  {
    linear,
    viscoelastic,
    plastic,
    softening,
    formula,
    hyperelastic,
    user,      // of stresses
    user_bonds // the same entry, of bonds
  };

  /** What says when a bond breaks. */
  enum class BreakCriterion
  {
    stretch,
    energy,           // stored in the bond
    principal_stress, // the largest one of its ends
    von_mises
  };

  /** SofteningCurve. */
  enum class Softening
  {
    linear,
    bilinear,
    exponential
  };

  /**
   * By what the stiffness of a bond of the bond-based solid is divided: q of the families of its
   * ends as they are, or of a complete one.
   */
  enum class Micromodulus
  {
    family,
    constant
  };

  enum class ElasticSolver
  {
    linear,
    newton,
    conjugate_gradients,
    dynamic_relaxation,
    adaptive_dynamic_relaxation,
    dynamics
  };
} // namespace PeriDeal
