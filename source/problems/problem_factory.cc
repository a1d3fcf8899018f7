// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/user_error.h>
#include <perideal/laws/elasticity.h>
#include <perideal/problems/diffusion_problem.h>
#include <perideal/problems/problem_factory.h>
#include <perideal/problems/solid_problem.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/with_formulas.h>

#include <algorithm>

#include "crack_note.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    /** What cannot be computed, so that no scene is silently taken for another. */
    template <int dim>
    void refuse_what_is_not_computed(const Scene<dim> &scene)
    {
      const auto require = [](const bool ok, const std::string &what) {
        AssertThrow(ok, UserError(what));
      };
      const auto &models = scene.general.models;
      require(
        scene.elasticity.kinematics == Kinematics::linear ||
          std::find(models.begin(), models.end(), ModelKind::finite_elements) == models.end(),
        "'Kinematics' in section 'Elasticity': 'full' is for 'Models = peridynamics' alone; finite elements have small displacements. "
        "Leave them out, or use 'linear'.");
      require(scene.cracks.tips.empty(),
              "'Growth' in section 'Cracks' cannot be used with 'Physics = elasticity' yet.");
      require(scene.domain.coarsening == 0,
              "'Coarsening' in section 'Domain' cannot be used with 'Physics = elasticity' yet.");
    }


    /** Bonds alone have a Poisson ratio of their own, and keep the bulk modulus. Collective. */
    template <int dim>
    void note_own_poisson_ratio(const Scene<dim>         &scene,
                                const Triangulation<dim> &mesh,
                                std::vector<std::string> &notes)
    {
      const auto &models = scene.general.models;
      if (dim == 1 || scene.elasticity.model != ElasticModel::bond_based ||
          std::find(models.begin(), models.end(), ModelKind::peridynamics) == models.end())
        return;
      const double own    = bond_based_poisson(dim, scene.elasticity.plane);
      double       lowest = 1., highest = -1.;
      for (const auto &cell : mesh.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            const double nu = scene.material.moduli(cell->center()).poisson();
            lowest          = std::min(lowest, nu);
            highest         = std::max(highest, nu);
          }
      lowest  = Utilities::MPI::min(lowest, mesh.get_communicator());
      highest = Utilities::MPI::max(highest, mesh.get_communicator());
      if (std::max(highest - own, own - lowest) < 1e-3)
        return;
      std::string found = number_text(lowest);
      if (highest > lowest)
        found += " to " + number_text(highest);
      notes.push_back(
        "'Model = bond-based' in section 'Elasticity' has a Poisson ratio of " + number_text(own) +
        " whatever 'Material' says, which is " + found +
        ": only the stiffness against equal strains in all directions is that of the material. "
        "Use 'state-based', or that Poisson ratio.");
    }


    /** Of cracks that grow, and entries that have no effect. */
    template <int dim>
    void note_diffusion(const Scene<dim> &scene, std::vector<std::string> &notes)
    {
      if (!scene.cracks.tips.empty())
        {
          const CrackHistory<dim> history = scene.crack_history();
          notes.push_back(
            "the cracks grow in " + std::to_string(history.events().size()) +
            " events, between which no tip advances more than " +
            number_text(history.longest_advance()) +
            "; bonds are cut too early or too late by at most the time that it needs for half of that ('Growth step' in section "
            "'Cracks').");
        }
      if (!scene.peridynamics.natural_fluxes() && scene.boundary_conditions.flux.empty())
        notes.push_back(
          "'Flux treatment' in section 'Peridynamics' has no effect: no side is named in 'Flux' (an insulated side "
          "needs 'side: 0' there).");
    }
  } // namespace


  template <int dim>
  void require_computable(const Scene<dim> &scene)
  {
    if (scene.general.physics == Physics::elasticity)
      refuse_what_is_not_computed(scene);
  }


  template <int dim>
  unsigned int n_components_of(const Scene<dim> &scene)
  {
    return scene.general.physics == Physics::elasticity ? dim : 1;
  }


  template <int dim>
  bool may_solve_again(const Scene<dim> &scene)
  {
    return scene.general.physics == Physics::elasticity && scene.elasticity.is_static() &&
           (scene.material.fracture_energy || scene.material.critical_stretch);
  }


  template <int dim>
  void describe_physics(const Scene<dim> &scene, nlohmann::ordered_json &summary)
  {
    summary["units"]          = {{"length", scene.units.length},
                                 {"time", scene.units.time},
                                 {"temperature", scene.units.temperature},
                                 {"force", scene.units.force},
                                 {"energy", scene.units.energy},
                                 {"mass", scene.units.mass},
                                 {"current", scene.units.current},
                                 {"field", scene.units.of_field(scene.general.physics)}};
    const PhysicsNames &names = names_of(scene.general.physics);
    summary["physics"]        = names.physics;
    summary["names"]          = {{"field", names.field},
                                 {"flux", names.flux},
                                 {"content", names.content},
                                 {"flow", names.flow},
                                 {"quantity", names.quantity},
                                 {"property", names.property}};
  }


  template <int dim>
  void note_scene(const Scene<dim>         &scene,
                  const Triangulation<dim> &mesh,
                  std::vector<std::string> &notes)
  {
    if (scene.general.physics == Physics::elasticity)
      return note_own_poisson_ratio(scene, mesh, notes);
    note_missing_crack_scaling(scene, notes);
    note_diffusion(scene, notes);
  }


  template <int dim>
  std::unique_ptr<Problem<dim>> make_problem(const ModelKind           model,
                                             const Triangulation<dim> &mesh,
                                             const Scene<dim>         &scene)
  {
    if (scene.general.physics == Physics::elasticity)
      return make_solid_problem(model, mesh, scene);
    std::unique_ptr<Problem<dim>> problem;
    with_formulas(mesh.get_communicator(),
                  [&] { problem = make_diffusion_problem(model, mesh, scene); });
    return problem;
  }


  template <int dim>
  Problems<dim> make_companions(const Problems<dim>      &problems,
                                const Triangulation<dim> &mesh,
                                const Scene<dim>         &scene,
                                std::vector<std::string> &notes)
  {
    Problems<dim> companions;
    if (!scene.heat)
      return companions;
    std::vector<std::string> of_heat;
    note_diffusion(*scene.heat, of_heat);
    for (unsigned int k = 0; k < problems.size(); ++k)
      {
        companions.push_back(make_problem(scene.general.models[k], mesh, *scene.heat));
        for (const std::string &note : companions.back()->notes())
          of_heat.push_back(note);
        static_cast<SolidProblem<dim> &>(*problems[k]).heat =
          static_cast<const DiffusionProblem<dim> *>(companions.back().get());
      }
    for (const std::string &note : of_heat)
      notes.push_back("temperature: " + note);
    return companions;
  }


#define PERIDEAL_INSTANTIATE(dim)                                                       \
  template void         require_computable(const Scene<dim> &);                         \
  template unsigned int n_components_of(const Scene<dim> &);                            \
  template bool         may_solve_again(const Scene<dim> &);                            \
  template void         describe_physics(const Scene<dim> &, nlohmann::ordered_json &); \
  template void         note_scene(const Scene<dim> &,                                  \
                                   const Triangulation<dim> &,                          \
                                   std::vector<std::string> &);                         \
  template std::unique_ptr<Problem<dim>> make_problem(const ModelKind,                  \
                                                      const Triangulation<dim> &,       \
                                                      const Scene<dim> &);              \
  template Problems<dim>                 make_companions(const Problems<dim> &,         \
                                                         const Triangulation<dim> &,    \
                                                         const Scene<dim> &,            \
                                                         std::vector<std::string> &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
