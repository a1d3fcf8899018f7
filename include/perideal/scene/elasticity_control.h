// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#pragma once

#include <perideal/scene/choices.h>
#include <perideal/scene/control.h>
#include <perideal/scene/expression.h>
#include <perideal/scene/physics.h>
#include <perideal/scene/section.h>

#include <optional>
#include <string>

namespace PeriDeal
{
  /** Section `Elasticity`: which elastic body, and how its displacement is found. */
  class ElasticityControl : public SceneSection
  {
  public:
    ElasticityControl();

    ElasticModel model;
    Micromodulus micromodulus; // bond-based only
    PlaneState   plane;        // two dimensions only
    Kinematics   kinematics;
    // Of x, y, z; what strains the body is this times `Thermal expansion`; 0 where it is computed.
    Expression    temperature_change;
    bool          computes_temperature = false; // by the heat problem of the same scene
    double        reference_temperature;        // of the unstressed body, where it is computed
    double        broken_bonds_conduct;         // of heat: their transmission, 0 to 1
    double        dissipation_step;             // of `Breaking = controlled`, 0 to 1
    bool          contact = true;               // faces of cracks bear pressure where they can
    ElasticSolver solver;
    /** Absolute temperature of the unstressed body, of take_absolute_zero() only. */
    std::optional<double> absolute_reference;

    bool is_bond_based() const
    {
      return model == ElasticModel::bond_based;
    }

    /** Nodes have strains, from which a law of stresses makes the forces of their bonds. */
    bool is_correspondence() const
    {
      return model == ElasticModel::correspondence;
    }

    /** Strains are those of the deformed bonds. */
    bool has_full_kinematics() const
    {
      return kinematics == Kinematics::full;
    }

    /** All solvers but `dynamics` find the equilibrium, in which there is no time. */
    bool is_static() const
    {
      return solver != ElasticSolver::dynamics;
    }

    /** `Contact = true` is given. */
    bool contact_is_asked() const
    {
      return text("Contact") == "true";
    }

    /** Of `Solver = conjugate gradients`: it is preconditioned. */
    bool multigrid() const
    {
      return text("Preconditioner") == "multigrid";
    }

    // What bonds of bodies at rest do once the first have broken:
    /** Loads go back where bonds break. */
    bool controls_loads() const
    {
      return text("Breaking") == "controlled";
    }

    bool breaks_in_motion() const
    {
      return text("Breaking") != "at rest" && !controls_loads();
    }

    /** `conjugate gradients` and so on, as in scenes. */
    const std::string &solver_name() const
    {
      return text("Solver");
    }

    /**
     * Throws UserError: a `Micromodulus` of another model than `bond-based`, a `Plane` where there
     * is none, full kinematics by the linear solver or with `Contact = true`, `Breaking` of a body
     * in motion, a temperature change that depends on t or is computed for a body in motion, and
     * with another physics any entry that is given.
     */
    void parse(const Physics physics = Physics::elasticity, const unsigned int dim = 2);

    /**
     * After parse(). Throws UserError: `Heat of deformation` without a temperature that is computed
     * or an `Absolute zero` below `Reference temperature`.
     */
    void take_absolute_zero(const Units &units);

  private:
    void declare_breaking();
    void parse_breaking(const unsigned int dim) const;
  };
} // namespace PeriDeal
