// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// The heat problem that an elastic scene describes beside its equilibrium.

#include <perideal/base/user_error.h>

#include "scene_checks.h"

namespace PeriDeal
{
  template <int dim>
  void make_heat_problem(Scene<dim> &scene)
  {
    scene.heat.reset();
    if (scene.general.physics != Physics::elasticity || !scene.elasticity.computes_temperature)
      return;
    const auto                        problem = std::make_shared<Scene<dim>>();
    const std::vector<SceneSection *> from = scene.sections(), to = problem->sections();
    for (unsigned int k = 0; k < from.size(); ++k)
      if (from[k] != &scene.elasticity && from[k] != &scene.output &&
          from[k] != &scene.checkpoint && from[k] != &scene.reference)
        for (const Entry &entry : from[k]->entries())
          to[k]->set(entry.name, entry.text);
    problem->general.set("Physics", names_of(Physics::heat).physics);
    for (const char *const entry :
         {"Displacement", "Displacement layer", "Velocity", "Traction", "Traction layer"})
      problem->boundary_conditions.set(entry, "");
    for (const char *const entry : {"Body force", "Initial displacement", "Initial velocity"})
      problem->initial_and_source.set(entry, "");
    // Corrections of elastic bonds are none of those that conduct.
    if (scene.peridynamics.surface_correction != SurfaceCorrection::crack_scaling)
      problem->peridynamics.set("Surface correction", "none");
    problem->peridynamics.set("Operator form", "auto"); // that of elastic bonds is meant
    // Where no lattice mirrors its nodes in it, a plane of symmetry is an insulated side.
    if (!scene.domain.has_lattice() ||
        (scene.cracks.mesh == CrackMesh::faces && !scene.cracks.cracks.empty()))
      problem->boundary_conditions.set("Symmetry", "");
    // Both share the mesh.
    problem->cracks.set("Mesh", scene.cracks.mesh == CrackMesh::faces ? "faces" : "removed");
    problem->cracks.set("Nodes on cracks", "left");
    if (scene.domain.has_lattice() && scene.domain.shape != Shape::image &&
        !scene.domain.has_extra_layers())
      {
        std::string cells;
        for (const unsigned int n : scene.domain.cells)
          cells += (cells.empty() ? "" : ", ") + std::to_string(n);
        problem->domain.set("Node spacing", "");
        problem->domain.set("Cells", cells);
      }
    problem->domain.scene_folder = scene.domain.scene_folder;
    problem->domain.communicator = scene.domain.communicator;
    try
      {
        problem->parse_and_validate();
      }
    catch (const UserError &fault)
      {
        AssertThrow(
          false,
          UserError("The heat problem of 'Temperature change = computed': " + fault.message()));
      }
    scene.heat = problem;
  }


  template void make_heat_problem(Scene<1> &);
  template void make_heat_problem(Scene<2> &);
  template void make_heat_problem(Scene<3> &);
} // namespace PeriDeal
