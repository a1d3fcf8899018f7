// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// The heat problem that an elastic scene describes beside its equilibrium.

#include <perideal/base/user_error.h>
#include <perideal/scene/scene.h>

namespace PeriDeal
{
  template <int dim>
  void Scene<dim>::make_heat_problem()
  {
    heat.reset();
    if (general.physics != Physics::elasticity || !elasticity.computes_temperature)
      return;
    const auto                        problem = std::make_shared<Scene<dim>>();
    const std::vector<SceneSection *> from = sections(), to = problem->sections();
    for (unsigned int k = 0; k < from.size(); ++k)
      if (from[k] != &elasticity && from[k] != &output && from[k] != &checkpoint &&
          from[k] != &reference)
        for (const Entry &entry : from[k]->entries())
          to[k]->set(entry.name, entry.text);
    problem->general.set("Physics", names_of(Physics::heat).physics);
    for (const char *const entry :
         {"Displacement", "Displacement layer", "Velocity", "Traction", "Traction layer"})
      problem->boundary_conditions.set(entry, "");
    for (const char *const entry : {"Body force", "Initial displacement", "Initial velocity"})
      problem->initial_and_source.set(entry, "");
    // Corrections of elastic bonds are none of those that conduct.
    if (peridynamics.surface_correction != SurfaceCorrection::crack_scaling)
      problem->peridynamics.set("Surface correction", "none");
    problem->peridynamics.set("Operator form", "auto"); // that of elastic bonds is meant
    // Where no lattice mirrors its nodes in it, a plane of symmetry is an insulated side.
    if (domain.shape == Shape::mesh_file ||
        (cracks.mesh == CrackMesh::faces && !cracks.cracks.empty()))
      problem->boundary_conditions.set("Symmetry", "");
    // Both share the mesh.
    problem->cracks.set("Mesh", cracks.mesh == CrackMesh::faces ? "faces" : "removed");
    problem->cracks.set("Nodes on cracks", "left");
    if (domain.shape != Shape::mesh_file && domain.shape != Shape::image &&
        !domain.has_extra_layers())
      {
        std::string cells;
        for (const unsigned int n : domain.cells)
          cells += (cells.empty() ? "" : ", ") + std::to_string(n);
        problem->domain.set("Node spacing", "");
        problem->domain.set("Cells", cells);
      }
    problem->domain.scene_folder = domain.scene_folder;
    problem->domain.communicator = domain.communicator;
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
    heat = problem;
  }


  template <int dim>
  bool Scene<dim>::warms_slowly() const
  {
    return heat && !heat->time.steady;
  }


  template void Scene<1>::make_heat_problem();
  template void Scene<2>::make_heat_problem();
  template void Scene<3>::make_heat_problem();
  template bool Scene<1>::warms_slowly() const;
  template bool Scene<2>::warms_slowly() const;
  template bool Scene<3>::warms_slowly() const;
} // namespace PeriDeal
