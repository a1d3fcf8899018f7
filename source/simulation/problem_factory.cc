// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include "problem_factory.h"

#include <deal.II/base/mpi.h>

#include <perideal/base/user_error.h>
#include <perideal/laws/elasticity.h>
#include <perideal/scene/lists.h>
#include <perideal/simulation/elastic_run.h>
#include <perideal/simulation/model_run.h>

#include <algorithm>

#include "crack_note.h"
#include "with_formulas.h"

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
      require(scene.reference.solution.empty(),
              "'Solution' in section 'Reference' cannot be used with 'Physics = elasticity' yet.");
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
      if (scene.peridynamics.flux_treatment != FluxTreatment::natural &&
          scene.boundary_conditions.flux.empty())
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
      return make_elastic_run(model, mesh, scene);
    std::unique_ptr<Problem<dim>> problem;
    with_formulas(mesh.get_communicator(),
                  [&] { problem = make_model_run(model, mesh, scene); });
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
        static_cast<ElasticRun<dim> &>(*problems[k]).heat =
          static_cast<const ModelRun<dim> *>(companions.back().get());
      }
    for (const std::string &note : of_heat)
      notes.push_back("temperature: " + note);
    return companions;
  }


#define PERIDEAL_INSTANTIATE(dim)                                                                  \
  template void require_computable(const Scene<dim> &);                                            \
  template void note_scene(const Scene<dim> &,                                                     \
                           const Triangulation<dim> &,                                             \
                           std::vector<std::string> &);                                            \
  template std::unique_ptr<Problem<dim>> make_problem(const ModelKind,                             \
                                                      const Triangulation<dim> &,                  \
                                                      const Scene<dim> &);                         \
  template Problems<dim> make_companions(const Problems<dim> &,                                    \
                                         const Triangulation<dim> &,                               \
                                         const Scene<dim> &,                                       \
                                         std::vector<std::string> &);
  PERIDEAL_INSTANTIATE(1)
  PERIDEAL_INSTANTIATE(2)
  PERIDEAL_INSTANTIATE(3)
#undef PERIDEAL_INSTANTIATE
} // namespace PeriDeal
