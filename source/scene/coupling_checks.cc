// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

// What exchange and the other couplings need of the rest of a scene.

#include <perideal/scene/lists.h>

#include <algorithm>

#include "scene_checks.h"

namespace PeriDeal
{
  namespace
  {
    /** An entry that bonds beside finite elements cannot have, and why. */
    struct Obstacle
    {
      std::string where, reason;
    };


    template <int dim>
    std::vector<Obstacle> obstacles_to_bonds_on_elements(const Scene<dim> &scene)
    {
      const Peridynamics   &pd = scene.peridynamics;
      std::vector<Obstacle> list;
      const auto add = [&](const bool wrong, const std::string &where, const std::string &reason) {
        if (wrong)
          list.push_back({where, reason});
      };
      add(scene.domain.nodes != NodePlacement::vertices,
          scene.domain.where("Nodes"),
          std::string(scene.domain.shape == Shape::image ?
                        "is 'cell centers', which is what 'auto' means with 'Shape = image'" :
                        "is 'cell centers'") +
            "; bonds and elements share the nodes on the vertices: set 'Nodes = vertices'");
      add(pd.flux_treatment != FluxTreatment::natural,
          pd.where("Flux treatment"),
          "makes slaves of nodes; use 'natural'");
      add(pd.self_term != SelfTerm::none, pd.where("Self term"), "is not 'none'");
      add(pd.corrects_elastic_bonds(),
          pd.where("Surface correction"),
          "is for bonds without finite elements; use 'none' or 'crack scaling'");
      add(pd.nodal_volume != NodalVolume::partial,
          pd.where("Nodal volume"),
          "is 'full'; use 'partial'");
      add(scene.general.physics != Physics::elasticity && scene.material.depends_on_temperature(),
          scene.material.where("Conductivity"),
          "or the heat capacity depends on T, which bonds beside elements do not follow");
      return list;
    }


    const char *const own_treatments =
      " Use 'Boundary treatment = none' (section 'Peridynamics') for bonds alone.";


    template <int dim>
    void check_adaptive_zone(const Scene<dim> &scene)
    {
      const std::string entry = scene.coupling.where("Zone");
      if (scene.coupling.zone != ZoneKind::adaptive)
        return;
      if (!runs(scene, ModelKind::coupled))
        entry_error(entry,
                    "is 'adaptive', but 'Models' has no 'coupled', which the mesh would follow.");
      if (scene.domain.coarsening == 0)
        entry_error(
          entry,
          "'adaptive' changes the mesh, but 'Coarsening' in section 'Domain' is 0: no cell may be "
          "larger than those of 'Cells'. Give it at least 1.");
      if (scene.cracks.mesh == CrackMesh::faces)
        entry_error(
          entry,
          "'adaptive' is for cracks that lie across cells; 'Mesh' in section 'Cracks' is 'faces'.");
      if (scene.time.time_step > 0. &&
          (scene.time.stepper == "euler" || scene.time.stepper == "rk4"))
        entry_error(
          entry,
          "'adaptive' changes the mesh and with it the stability bound of '" + scene.time.stepper +
            "', for which 'Time step' in section 'Time' is given. Use 'Time step = auto' or 'Stepper = auto'.");
    }
  } // namespace


  template <int dim>
  void resolve_boundary_treatment(Scene<dim> &scene)
  {
    const auto list = obstacles_to_bonds_on_elements(scene);
    if (scene.peridynamics.treatment == BoundaryTreatment::automatic)
      scene.peridynamics.treatment = list.empty() && scene.general.physics != Physics::elasticity ?
                                       BoundaryTreatment::exchange :
                                       BoundaryTreatment::none;
    else if (scene.peridynamics.treatment == BoundaryTreatment::exchange && !list.empty() &&
             runs(scene, ModelKind::peridynamics))
      entry_error(list.front().where,
                  list.front().reason + ", for 'Boundary treatment = exchange'." + own_treatments);
  }


  template <int dim>
  void check_coupling(const Scene<dim> &scene)
  {
    check_adaptive_zone(scene);
    if (!runs(scene, ModelKind::coupled))
      return;
    const auto list = obstacles_to_bonds_on_elements(scene);
    if (!list.empty())
      entry_error(list.front().where, list.front().reason + ", for 'Models = coupled'.");
    if (dim == 1 && scene.coupling.zone == ZoneKind::near_cracks)
      entry_error(
        scene.coupling.where("Zone"),
        "'" + scene.coupling.zone_text() +
          "' needs a crack, and bodies of 'Dimension' 1 have none. Give a formula of x, or 'everywhere'.");
    if ((scene.coupling.zone == ZoneKind::near_cracks ||
         scene.coupling.zone == ZoneKind::adaptive) &&
        scene.cracks.cracks.empty())
      entry_error(
        scene.coupling.where("Zone"),
        "'" + scene.coupling.zone_text() +
          "' lies around cracks, but section 'Cracks' has none: the zone is empty. Give a formula, or 'everywhere'.");
    double widest = 0.;
    for (unsigned int d = 0; d < dim; ++d)
      widest = std::max(widest, scene.domain.upper[d] - scene.domain.lower[d]);
    if (scene.domain.has_lattice() && scene.coupling.overlap * scene.horizon() > widest)
      entry_error(scene.coupling.where("Overlap"),
                  "is " + number_text(scene.coupling.overlap) + " horizons, " +
                    number_text(scene.coupling.overlap * scene.horizon()) +
                    ", wider than the body, " + number_text(widest) + ".");
    if (scene.finite_elements.degree > 1)
      entry_error(
        scene.finite_elements.where("Degree"),
        "found " + std::to_string(scene.finite_elements.degree) +
          "; bonds and elements share the nodes of elements of degree 1 ('Models = coupled').");
  }


  template <int dim>
  void check_coarsening(const Scene<dim> &scene)
  {
    if (scene.domain.coarsening == 0)
      return;
    const std::string entry = scene.domain.where("Coarsening"),
                      found = "found " + std::to_string(scene.domain.coarsening) + ", but ";
    if (runs(scene, ModelKind::peridynamics))
      entry_error(
        entry,
        found +
          "'Models' has peridynamics, whose bonds need fine cells everywhere. Use 'coupled', or 0 here.");
    if (runs(scene, ModelKind::coupled) && scene.coupling.scheme != CouplingScheme::exchange)
      entry_error(
        entry,
        found +
          "'Scheme' in section 'Coupling' is not 'exchange', the only one for graded meshes.");
    const bool near_cracks = scene.coupling.zone == ZoneKind::near_cracks ||
                             scene.coupling.zone == ZoneKind::adaptive;
    if (!scene.domain.fine_by_formula && near_cracks && scene.cracks.cracks.empty())
      entry_error(
        entry,
        found +
          "section 'Cracks' has none for which cells would stay fine. Give a formula in 'Fine where'.");
  }


  template void check_coarsening(const Scene<1> &);
  template void check_coarsening(const Scene<2> &);
  template void check_coarsening(const Scene<3> &);
  template void resolve_boundary_treatment(Scene<1> &);
  template void resolve_boundary_treatment(Scene<2> &);
  template void resolve_boundary_treatment(Scene<3> &);
  template void check_coupling(const Scene<1> &);
  template void check_coupling(const Scene<2> &);
  template void check_coupling(const Scene<3> &);
} // namespace PeriDeal
