// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/beyond_sides.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <vector>

namespace PeriDeal
{
  using namespace dealii;

  template <int dim>
  std::string hindrance_of_fictitious_nodes(const Scene<dim> &scene)
  {
    if (scene.peridynamics.surface_correction != SurfaceCorrection::automatic)
      return {};
    if (scene.domain.shape == Shape::mesh_file)
      {
        const std::string on_mesh = "on a mesh from a file families do not go on ";
        if (dim == 1)
          return on_mesh + "in 1D";
        if (scene.domain.nodes == NodePlacement::cell_centers)
          return on_mesh + "with nodes at cell centres";
        if (scene.material.fracture_energy || scene.material.critical_stretch)
          return on_mesh + "where bonds may break";
        if (!scene.cracks.cracks.empty())
          return on_mesh + "with cracks";
      }
    if (scene.cracks.mesh == CrackMesh::faces && !scene.cracks.cracks.empty())
      return "cracks are cut into the mesh ('Mesh = faces')";
    if (scene.peridynamics.nodal_volume != NodalVolume::partial)
      return "nodes on sides have whole cells ('Nodal volume = full')";
    if (scene.elasticity.micromodulus == Micromodulus::constant)
      return "bonds at sides are those inside ('Micromodulus = constant')";
    return {};
  }


  template <int dim>
  std::array<BeyondSide, 2 * dim> beyond_sides(const Scene<dim> &scene)
  {
    std::array<BeyondSide, 2 * dim> beyond;
    beyond.fill(BeyondSide::nothing);
    const bool automatic = scene.peridynamics.surface_correction == SurfaceCorrection::automatic;
    if (!automatic && !scene.peridynamics.completes_families())
      return beyond;
    if (automatic &&
        (scene.domain.shape == Shape::mesh_file || !hindrance_of_fictitious_nodes(scene).empty()))
      return beyond;
    const auto &conditions = scene.boundary_conditions;
    const bool  brittle    = scene.material.fracture_energy || scene.material.critical_stretch;
    if (!automatic || !brittle)
      beyond.fill(BeyondSide::continued);
    const auto set = [&](const types::boundary_id side, const BeyondSide value) {
      if (side < 2 * dim)
        beyond[side] = value;
    };
    for (const auto *const list : {&conditions.displacement, &conditions.traction})
      for (const VectorCondition &condition : *list)
        set(conditions.side_of(condition.id), BeyondSide::continued);
    for (const types::boundary_id side : conditions.symmetry)
      set(side, BeyondSide::mirrored);
    for (unsigned int side = 0; side < 2 * dim; ++side)
      if (automatic && scene.domain.has_extra_layers() && scene.domain.extra_layers[side] > 0)
        beyond[side] = BeyondSide::nothing;
    return beyond;
  }


  template <int dim>
  bool completes_mesh(const Scene<dim> &scene)
  {
    return scene.domain.shape == Shape::mesh_file && scene.general.physics == Physics::elasticity &&
           scene.peridynamics.surface_correction == SurfaceCorrection::automatic &&
           hindrance_of_fictitious_nodes(scene).empty();
  }


  template <int dim>
  std::string automatic_correction(const Scene<dim> &scene)
  {
    const std::string reason = hindrance_of_fictitious_nodes(scene);
    if (!reason.empty())
      return "none, because " + reason;
    if (completes_mesh(scene))
      return "fictitious nodes beyond the whole boundary";
    const auto               beyond = beyond_sides(scene);
    std::vector<std::string> names;
    for (unsigned int side = 0; side < 2 * dim; ++side)
      if (beyond[side] != BeyondSide::nothing)
        names.push_back(name_of_side(side, true));
    return names.empty() ? "none" : "fictitious nodes beyond " + join_names(names);
  }


#define PERIDEAL_INSTANTIATE(dim)                                                   \
  template std::array<BeyondSide, 2 * dim> beyond_sides(const Scene<dim> &scene);   \
  template bool                            completes_mesh(const Scene<dim> &scene); \
  template std::string                     automatic_correction(const Scene<dim> &scene);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
