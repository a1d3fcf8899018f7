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

    double              horizon_ratio        = 3.;  // m, used when horizon is not given
    double              horizon              = -1.; // length; negative: not given
    KernelShape         kernel               = KernelShape::conical;
    unsigned int        kernel_exponent      = 2;
    VolumeFraction      volume_fraction      = VolumeFraction::linear;
    Calibration         calibration          = Calibration::discrete;
    SelfTerm            self_term            = SelfTerm::none;
    NodalVolume         nodal_volume         = NodalVolume::partial;
    BoundaryTreatment   treatment            = BoundaryTreatment::automatic; // resolved by Scene
    unsigned int        layer_rows           = 1;
    FluxTreatment       flux_treatment       = FluxTreatment::natural;
    SurfaceCorrection   surface_correction   = SurfaceCorrection::none;
    CorrectionDirection correction_direction = CorrectionDirection::both;
    BondsAcrossVoids    across_voids         = BondsAcrossVoids::automatic;
    OperatorForm form = OperatorForm::automatic; // entry `Operator form` = auto | lattice | stored

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
    bool has_fictitious_nodes() const;

    /** What is beside a crack makes up for what the crack cuts (CrackSideFactors). */
    bool scales_beside_cracks() const;

    /** The surface correction is one of the linear peridynamic solid. */
    bool corrects_elastic_bonds() const;

    /** Elastic families go on beyond the sides of the body (FictitiousExtension). */
    bool completes_families() const;

    /** Throws UserError for values out of range and contradicting entries. */
    void parse(const Physics physics = Physics::heat);

  private:
    void declare_quadrature();

    void declare_boundary();
  };


  /** Section `Finite elements`. */
  class FiniteElements : public SceneSection
  {
  public:
    FiniteElements();

    unsigned int degree              = 1;
    bool         consistent_capacity = false;

    /** @param with_heat an elastic body has a temperature that is computed */
    void parse(const Physics physics = Physics::heat, const bool with_heat = false);
  };
} // namespace PeriDeal
