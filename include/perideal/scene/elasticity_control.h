// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/choices.h>
#include <perideal/scene/expression.h>
#include <perideal/scene/physics.h>
#include <perideal/scene/section.h>

#include <string>

namespace PeriDeal
{
  /** Section `Elasticity`: which elastic body, and how its displacement is found. */
  class ElasticityControl : public SceneSection
  {
  public:
    ElasticityControl();

    ElasticModel model        = ElasticModel::state_based;
    Micromodulus micromodulus = Micromodulus::family; // bond-based only
    PlaneState   plane        = PlaneState::stress;   // two dimensions only
    Kinematics   kinematics   = Kinematics::linear;
    // Of x, y, z; what strains the body is this times `Thermal expansion`; 0 where it is computed.
    Expression    temperature_change;
    bool          computes_temperature  = false; // by the heat problem of the same scene
    double        reference_temperature = 0.;    // of the unstressed body, where it is computed
    double        broken_bonds_conduct  = 0.;    // of heat: their transmission, 0 to 1
    bool          contact               = true;  // faces of cracks bear pressure where they can
    bool          contact_is_asked      = false; // 'true' is given
    ElasticSolver solver                = ElasticSolver::linear;
    bool          multigrid             = true; // entry `Preconditioner`
    bool          breaks_in_motion      = true; // bonds of bodies at rest, entry `Breaking`

    bool is_bond_based() const
    {
      return model == ElasticModel::bond_based;
    }

    /** Strains are those of the deformed bonds. */
    bool has_full_kinematics() const;

    /** All solvers but `dynamics` find the equilibrium, in which there is no time. */
    bool is_static() const;

    /** `conjugate gradients` and so on, as in scenes. */
    const std::string &solver_name() const;

    /**
     * Throws UserError: a `Micromodulus` of another model than `bond-based`, a `Plane` where there
     * is none, full kinematics by the linear solver or with `Contact = true`, `Breaking` of a body
     * in motion, a temperature change that depends on t or is computed for a body in motion, and
     * with another physics any entry that is given.
     */
    void parse(const Physics physics = Physics::elasticity, const unsigned int dim = 2);
  };
} // namespace PeriDeal
