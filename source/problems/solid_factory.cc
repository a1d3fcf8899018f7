// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/user_error.h>
#include <perideal/laws/elasticity.h>
#include <perideal/problems/diffusion_problem.h>
#include <perideal/problems/solid_problem.h>
#include <perideal/scene/lists.h>
#include <perideal/scene/with_formulas.h>

#include <algorithm>

#include "crack_note.h"
#include "physics_factories.h"

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
      if (!scene.cracks.tips.empty() && scene.peridynamics.corrects_elastic_bonds())
        entry_error(scene.peridynamics.where("Surface correction"),
                    "does not follow cracks that grow ('Growth', 'Paths' in section 'Cracks') in a "
                    "body that deforms. Use 'none' or 'fictitious nodes'.");
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


    template <int dim>
    class SolidFactory : public ProblemFactory<dim>
    {
    public:
      void require_computable(const Scene<dim> &scene) const override
      {
        refuse_what_is_not_computed(scene);
      }

      unsigned int n_components() const override
      {
        return dim;
      }

      bool may_solve_again(const Scene<dim> &scene) const override
      {
        return scene.elasticity.is_static() &&
               (scene.material.fracture_energy || scene.material.critical_stretch ||
                !scene.cracks.tips.empty());
      }

      void note_scene(const Scene<dim>         &scene,
                      const Triangulation<dim> &mesh,
                      std::vector<std::string> &notes) const override
      {
        note_own_poisson_ratio(scene, mesh, notes);
        note_growth(scene, notes);
      }

      std::unique_ptr<Problem<dim>> make_problem(Model<dim>       &model,
                                                 const Scene<dim> &scene) const override
      {
        if (scene.heat)
          {
            model.share_nodes(scene);
            model.share_nodes(*scene.heat);
          }
        return make_solid_problem(model, scene);
      }

      /** What computes the temperature. */
      void add_companions(const Models<dim>        &models,
                          const Scene<dim>         &scene,
                          std::vector<std::string> &notes) const override
      {
        if (!scene.heat)
          return;
        std::vector<std::string> of_heat;
        note_diffusion(*scene.heat, of_heat);
        for (const auto &model : models)
          {
            std::unique_ptr<DiffusionProblem<dim>> heat;
            with_formulas(model->mesh.get_communicator(),
                          [&] { heat = make_diffusion_problem(*model, *scene.heat); });
            for (const std::string &note : heat->notes())
              of_heat.push_back(note);
            const auto solid = dynamic_cast<SolidProblem<dim> *>(model->problem.get());
            Assert(solid, ExcMessage("Only problems of this factory have a temperature to find."));
            solid->heat = heat.get();
            model->companions.push_back(std::move(heat));
          }
        for (const std::string &note : of_heat)
          notes.push_back("temperature: " + note);
      }
    };
  } // namespace


  template <int dim>
  std::unique_ptr<ProblemFactory<dim>> make_solid_factory()
  {
    return std::make_unique<SolidFactory<dim>>();
  }


  template std::unique_ptr<ProblemFactory<1>> make_solid_factory();
  template std::unique_ptr<ProblemFactory<2>> make_solid_factory();
  template std::unique_ptr<ProblemFactory<3>> make_solid_factory();
} // namespace PeriDeal
