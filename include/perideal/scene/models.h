// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/choices.h>
#include <perideal/scene/physics.h>
#include <perideal/scene/section.h>

#include <string>

namespace PeriDeal
{
  /** Section `Peridynamics`. */
  class Peridynamics : public SceneSection
  {
  public:
    Peridynamics();

    double              horizon_ratio; // m, used when horizon is not given
    double              horizon;       // length; negative: not given
    KernelShape         kernel;
    unsigned int        kernel_exponent = 2;
    BoundaryTreatment   treatment; // resolved by Scene
    unsigned int        layer_rows;
    FluxTreatment       flux_treatment;
    SurfaceCorrection   surface_correction;
    CorrectionDirection correction_direction;
    BondsAcrossVoids    across_voids;
    OperatorForm        form;

    /** How sums over nodes stand for integrals over families. */
    struct Sampling
    {
      VolumeFraction volume_fraction;
      Calibration    calibration;
      SelfTerm       self_term;
      NodalVolume    nodal_volume;
    };

    Sampling sampling;

    /** Fluxes are sources in the outermost nodes: no values there follow from others. */
    bool natural_fluxes() const
    {
      return flux_treatment == FluxTreatment::natural;
    }

    /** Bonds are to have the lattice form, or the scene is refused. */
    bool wants_lattice_form() const
    {
      return form == OperatorForm::lattice;
    }

    /** Prescribed values are those of layers of nodes. */
    bool has_layers() const
    {
      return treatment == BoundaryTreatment::layer;
    }

    bool extrapolates_layers() const
    {
      return flux_treatment == FluxTreatment::layer_extrapolation;
    }

    /** The prescribed values are those of nodes beyond the sides. */
    bool has_fictitious_nodes() const
    {
      return treatment == BoundaryTreatment::fictitious_mirror ||
             treatment == BoundaryTreatment::fictitious_constant;
    }

    /** What is beside a crack makes up for what the crack cuts (CrackSideFactors). */
    bool scales_beside_cracks() const
    {
      return surface_correction == SurfaceCorrection::crack_scaling;
    }

    /** The surface correction is one of the linear peridynamic solid. */
    bool corrects_elastic_bonds() const
    {
      return surface_correction == SurfaceCorrection::energy ||
             surface_correction == SurfaceCorrection::moments;
    }

    /** Elastic families go on beyond the sides of the body (FictitiousExtension). */
    bool completes_families() const
    {
      return surface_correction == SurfaceCorrection::fictitious_nodes;
    }

    /** Throws UserError for values out of range and contradicting entries. */
    void parse(const Physics physics = Physics::heat);
  };


  /** Section `Finite elements`. */
  class FiniteElements : public SceneSection
  {
  public:
    FiniteElements();

    unsigned int degree;
    bool         consistent_capacity = false;

    /** @param with_heat an elastic body has a temperature that is computed */
    void parse(const Physics physics = Physics::heat, const bool with_heat = false);
  };
} // namespace PeriDeal
