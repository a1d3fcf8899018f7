// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <perideal/scene/beyond_sides.h>
#include <perideal/scene/lists.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    struct Hindrance
    {
      std::string reason, remedy;
    };


    template <int dim>
    std::string obstacle_on_mesh(const Scene<dim> &scene)
    {
      if (dim == 1)
        return "in 1D";
      return scene.domain.nodes == NodePlacement::cell_centers ? "with nodes at cell centres" : "";
    }


    /**
     * Families end at free sides: bonds there break as those of their own families, and nodes that
     * others follow are stiff, so that explicit steps would be short.
     */
    template <int dim>
    bool ends_at_free_sides(const Scene<dim> &scene)
    {
      return scene.material.fracture_energy || scene.material.critical_stretch ||
             scene.elasticity.solver == ElasticSolver::dynamics;
    }


    /** Why no families can go on beyond the sides; empty where they can. */
    template <int dim>
    Hindrance find_hindrance(const Scene<dim> &scene)
    {
      if (!scene.domain.has_lattice())
        if (const std::string obstacle = obstacle_on_mesh(scene); !obstacle.empty())
          return {"on a mesh from a file families do not go on " + obstacle,
                  "They do with 'Nodes = vertices' (section 'Domain')."};
      if (scene.cracks.mesh == CrackMesh::faces && !scene.cracks.cracks.empty())
        return {"cracks are cut into the mesh ('Mesh = faces')",
                "Families go on with 'Mesh = removed' (section 'Cracks')."};
      if (scene.peridynamics.nodal_volume != NodalVolume::partial)
        return {"nodes on sides have whole cells ('Nodal volume = full')",
                "Families go on with 'Nodal volume = partial'."};
      if (scene.elasticity.micromodulus == Micromodulus::constant)
        return {"bonds at sides are those inside ('Micromodulus = constant')",
                "Families go on with 'Micromodulus = family' (section 'Elasticity')."};
      return {};
    }


    /**
     * Sides and parts of sides where one row of nodes bears what acts, of the conditions that no
     * layer spreads.
     */
    template <int dim>
    std::vector<std::string> single_rows(const Scene<dim>                   &scene,
                                         const std::vector<VectorCondition> &list,
                                         const double                        layer,
                                         bool                               &flat)
    {
      const auto               beyond = beyond_sides(scene);
      std::vector<std::string> names;
      for (const VectorCondition &condition : list)
        {
          const types::boundary_id side = scene.boundary_conditions.side_of(condition.id);
          if (layer > 0. || side == numbers::invalid_boundary_id || completes_mesh(scene) ||
              (side < 2 * dim && beyond[side] != BeyondSide::nothing))
            continue;
          flat = flat && side < 2 * dim && scene.domain.has_lattice();
          names.push_back("'" + scene.boundary_conditions.name_of(condition.id) + "'");
        }
      return names;
    }
  } // namespace


  template <int dim>
  std::string hindrance_of_fictitious_nodes(const Scene<dim> &scene)
  {
    return scene.peridynamics.surface_correction == SurfaceCorrection::automatic ?
             find_hindrance(scene).reason :
             std::string();
  }


  template <int dim>
  std::string note_on_cut_sides(const Scene<dim> &scene)
  {
    const bool  automatic  = scene.peridynamics.surface_correction == SurfaceCorrection::automatic;
    const auto &conditions = scene.boundary_conditions;
    const Hindrance hindrance = find_hindrance(scene);
    if (!(automatic && !hindrance.reason.empty()) &&
        scene.peridynamics.surface_correction != SurfaceCorrection::none)
      return {};
    bool       flat = true;
    const auto held =
      single_rows(scene, conditions.displacement, conditions.displacement_layer, flat);
    const auto loaded = single_rows(scene, conditions.traction, conditions.traction_layer, flat);
    // With a constant micromodulus surfaces are meant to be soft.
    if (held.empty() && loaded.empty() &&
        (!automatic || scene.elasticity.micromodulus == Micromodulus::constant))
      return {};
    std::string              text  = automatic ?
                                       "Families of peridynamics end at the sides, because " + hindrance.reason :
                                       std::string("Families of peridynamics end at the sides "
                                                   "('Surface correction = none' in section 'Peridynamics')");
    std::vector<std::string> names = held;
    std::copy_if(loaded.begin(), loaded.end(), std::back_inserter(names), [&](const auto &name) {
      return std::find(held.begin(), held.end(), name) == held.end();
    });
    if (!names.empty())
      text += ", where one row of nodes bears what acts on " + join_names(names);
    text +=
      ". Displacements of sides that are held or loaded, and stresses within a horizon of all sides, "
      "do not converge as the nodes get denser. ";
    text += !hindrance.reason.empty() ? hindrance.remedy :
                                        "With 'auto' families go on beyond them.";
    if (names.empty() || !flat)
      return text;
    const std::string hold = "'Displacement layer' of two horizons",
                      pull = "'Traction layer' of a horizon";
    return text + " " +
           (held.empty()   ? pull :
            loaded.empty() ? hold :
                             hold + " and " + pull) +
           " (section 'Boundary conditions') " +
           (held.empty() || loaded.empty() ? "spreads" : "spread") + " it over a depth.";
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
        (!scene.domain.has_lattice() || !hindrance_of_fictitious_nodes(scene).empty()))
      return beyond;
    const auto &conditions = scene.boundary_conditions;
    if (!automatic || !ends_at_free_sides(scene))
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
    return !scene.domain.has_lattice() && scene.general.physics == Physics::elasticity &&
           scene.peridynamics.surface_correction == SurfaceCorrection::automatic &&
           hindrance_of_fictitious_nodes(scene).empty();
  }


  template <int dim>
  bool goes_on_beyond(const Scene<dim> &scene, const types::boundary_id side)
  {
    if (!ends_at_free_sides(scene))
      return true;
    const auto &conditions = scene.boundary_conditions;
    for (const auto *const list : {&conditions.displacement, &conditions.traction})
      for (const VectorCondition &condition : *list)
        if (conditions.side_of(condition.id) == side)
          return true;
    return false;
  }


  template <int dim>
  std::string automatic_correction(const Scene<dim> &scene)
  {
    if (const std::string reason = hindrance_of_fictitious_nodes(scene); !reason.empty())
      return "none, because " + reason;
    if (completes_mesh(scene))
      return ends_at_free_sides(scene) ? "fictitious nodes beyond sides with conditions" :
                                         "fictitious nodes beyond the whole boundary";
    const auto               beyond = beyond_sides(scene);
    std::vector<std::string> names;
    for (unsigned int side = 0; side < 2 * dim; ++side)
      if (beyond[side] != BeyondSide::nothing)
        names.push_back(name_of_side(side, true));
    return names.empty() ? "none" : "fictitious nodes beyond " + join_names(names);
  }


#define PERIDEAL_INSTANTIATE(dim)                                                              \
  template std::array<BeyondSide, 2 * dim> beyond_sides(const Scene<dim> &scene);              \
  template bool                            completes_mesh(const Scene<dim> &scene);            \
  template bool        goes_on_beyond(const Scene<dim> &scene, const types::boundary_id side); \
  template std::string automatic_correction(const Scene<dim> &scene);                          \
  template std::string note_on_cut_sides(const Scene<dim> &scene);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
