// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// The heat problem that an elastic scene describes beside its equilibrium.

#include <perideal/base/instantiate.h>
#include <perideal/base/user_error.h>

#include "scene_checks.h"

namespace PeriDeal
{
  namespace
  {
    /** The values of the sections that heat has in common with the elastic body. */
    template <int dim>
    void take_sections(const Scene<dim> &scene, Scene<dim> &heat)
    {
      heat.general            = scene.general;
      heat.domain             = scene.domain;
      heat.material           = scene.material;
      heat.initial_and_source = scene.initial_and_source;
      heat.finite_elements    = scene.finite_elements;
      heat.coupling           = scene.coupling;
      heat.time               = scene.time;
      heat.solver             = scene.solver;
      heat.units              = scene.units;
      heat.general.physics    = Physics::heat;
      heat.domain.notes.clear();
      heat.domain.islands.cells_are_given = true;
      heat.boundary_conditions            = scene.boundary_conditions;
      heat.boundary_conditions.displacement.clear();
      heat.boundary_conditions.traction.clear();
      // Where no lattice mirrors its nodes in it, a plane of symmetry is an insulated side.
      if (!scene.domain.has_lattice() || scene.cracks.double_nodes())
        heat.boundary_conditions.symmetry.clear();
    }


    /** Sections that are read in another way for diffusion. */
    template <int dim>
    void read_sections(const Scene<dim> &scene, Scene<dim> &heat)
    {
      heat.cracks       = scene.cracks;
      heat.peridynamics = scene.peridynamics;
      heat.cracks.set("Mesh", scene.cracks.on_faces() ? "faces" : "removed");
      if (scene.cracks.through_tips == ThroughTips::in_part) // that is for elastic bonds
        heat.cracks.set("Bonds through tips", "auto");
      heat.cracks.parse(Physics::heat);
      heat.cracks.cracks = scene.cracks.cracks; // with those of interfaces
      // Corrections of elastic bonds are none of those that conduct.
      if (!scene.peridynamics.scales_beside_cracks())
        heat.peridynamics.set("Surface correction", "none");
      heat.peridynamics.set("Operator form", "auto"); // that of elastic bonds is meant
      heat.peridynamics.parse(Physics::heat);
      heat.time.steady = heat.time.steady || !heat.material.stores;
      heat.take_times();
      heat.solver.parse();
      heat.units.parse();
      if (heat.time.steady)
        return;
      heat.material.require_storage();
      if (!scene.material.breaks())
        return;
      heat.broken_bonds_conduct = scene.elasticity.broken_bonds_conduct;
      // What the solid's cracks part must not conduct once the bonds ahead of them have broken.
      if (heat.broken_bonds_conduct < 1. && heat.cracks.through_tips == ThroughTips::automatic)
        heat.cracks.through_tips = ThroughTips::cut;
    }
  } // namespace


  void of_heat_problem(const std::function<void()> &action)
  {
    try
      {
        action();
      }
    catch (const UserError &fault)
      {
        AssertThrow(
          false,
          UserError("The heat problem of 'Temperature change = computed': " + fault.message()));
      }
  }


  template <int dim>
  void make_heat_problem(Scene<dim> &scene)
  {
    scene.heat.reset();
    if (scene.general.physics != Physics::elasticity || !scene.elasticity.computes_temperature)
      return;
    const auto heat = std::make_shared<Scene<dim>>();
    of_heat_problem([&] {
      take_sections(scene, *heat);
      read_sections(scene, *heat);
      heat->validate();
    });
    scene.elasticity.refuse(
      scene.elasticity.absolute_reference.has_value() && heat->time.steady,
      "Heat of deformation",
      "found 'true', but the temperature is steady ('Steady = true' in section 'Time') and does not change with time. Leave one of them out.");
    // A fraction of a degree is what matters then, of temperatures of hundreds.
    if (scene.elasticity.absolute_reference && !scene.time.is_given("Tolerance"))
      heat->time.tolerance = 1e-8;
    scene.heat = heat;
  }


  PERIDEAL_INSTANTIATE_FUNCTION(make_heat_problem);
} // namespace PeriDeal
