// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright (C) 2026 the PeriDeal authors

#include <deal.II/base/mpi.h>

#include <perideal/base/user_error.h>
#include <perideal/laws/elasticity.h>
#include <perideal/operators/solid/elastic_elements.h>
#include <perideal/operators/solid/state_operator.h>
#include <perideal/problems/diffusion_problem.h>
#include <perideal/problems/solid_problem.h>
#include <perideal/scene/expression.h>
#include <perideal/scene/lists.h>
#include <perideal/solvers/static_solver.h>

#include <algorithm>
#include <utility>

#include "crack_note.h"
#include "heat_of_deformation.h"
#include "physics_factories.h"
#include "solid_scene_notes.h"

namespace PeriDeal
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    void refuse_breaking(const Scene<dim> &scene)
    {
      scene.elasticity.refuse(
        scene.elasticity.is_given("Breaking") && !scene.material.fracture_energy &&
          !scene.material.critical_stretch,
        "Breaking",
        "is for bonds that break: give 'Fracture energy' or 'Critical stretch' in section 'Material', too, or leave it out.");
    }


    /** What only bonds have, or only those of one model, in a scene in which there are none. */
    template <int dim>
    void refuse_what_no_model_has(const Scene<dim> &scene)
    {
      const Peridynamics &pd       = scene.peridynamics;
      const Material     &material = scene.material;
      const bool          bonds    = runs(scene, ModelKind::peridynamics),
                 none              = !bonds && !runs(scene, ModelKind::coupled);
      pd.refuse(
        none && pd.completes_families(),
        "Surface correction",
        "'fictitious nodes' has no effect without 'Models = peridynamics' or 'coupled'. Use 'none'.");
      pd.refuse(
        !runs(scene, ModelKind::coupled) && pd.scales_beside_cracks(),
        "Surface correction",
        "'crack scaling' without 'Models = coupled' has no effect with 'Physics = elasticity'; use 'none', 'energy' or 'moments'.");
      material.refuse(
        none && (material.fracture_energy || material.critical_stretch),
        material.fracture_energy ? "Fracture energy" : "Critical stretch",
        "has no effect: finite elements do not break. Add 'peridynamics' or 'coupled' to 'Models', or leave the entry out.");
      material.refuse(material.scatter && runs(scene, ModelKind::coupled),
                      "Weibull modulus",
                      "is for 'Models = peridynamics', not 'coupled'; leave the entry out.");
      refuse_breaking(scene);
      scene.elasticity.refuse(
        scene.elasticity.contact_is_asked() && !bonds &&
          (none || !scene.coupling.exchanges() || scene.cracks.on_faces()),
        "Contact",
        "has no effect: it is for 'Models = peridynamics', and for 'coupled' with 'Scheme = exchange' where 'Mesh' in section 'Cracks' is not 'faces'. Leave it out, or add one of these.");
      if (bonds)
        return;
      pd.refuse(
        pd.corrects_elastic_bonds(),
        "Surface correction",
        "without 'Models = peridynamics' has no effect with 'Physics = elasticity'; use 'none'.");
      pd.refuse(
        pd.wants_lattice_form(),
        "Operator form",
        "'lattice' is not defined without 'Models = peridynamics' with 'Physics = elasticity'; use 'auto'.");
      scene.boundary_conditions.refuse(
        scene.boundary_conditions.traction_layer > 0.,
        "Traction layer",
        "has no effect without 'Models = peridynamics': finite elements have "
        "tractions on their faces. Leave it empty.");
      scene.elasticity.refuse(
        scene.elasticity.micromodulus == Micromodulus::constant,
        "Micromodulus",
        "'constant' is for peridynamics in the whole body: add 'peridynamics' to 'Models', or leave the entry out.");
    }


    /** The smallest and the largest Poisson ratio in cells of the body. Collective. */
    template <int dim>
    std::pair<double, double> poisson_ratios(const Scene<dim>         &scene,
                                             const Triangulation<dim> &mesh)
    {
      double lowest = 1., highest = -1.;
      for (const auto &cell : mesh.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            const double nu = scene.material.moduli(cell->center()).poisson();
            lowest          = std::min(lowest, nu);
            highest         = std::max(highest, nu);
          }
      return {Utilities::MPI::min(lowest, mesh.get_communicator()),
              Utilities::MPI::max(highest, mesh.get_communicator())};
    }


    /** Bonds alone have a Poisson ratio of their own, and keep the bulk modulus. */
    template <int dim>
    void note_own_poisson_ratio(const Scene<dim>         &scene,
                                const double              lowest,
                                const double              highest,
                                std::vector<std::string> &notes)
    {
      if (dim == 1 || !scene.elasticity.is_bond_based() || !runs(scene, ModelKind::peridynamics))
        return;
      const double own = bond_based_poisson(dim, scene.elasticity.plane);
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
        for (const ModelKind model : scene.general.models)
          if (model == ModelKind::peridynamics)
            StateOperator<dim>::require(scene);
          else
            ElasticElements<dim>::require(scene, model == ModelKind::coupled);
        refuse_what_no_model_has(scene);
        HeatOfDeformation<dim>::require(scene);
        if (scene.elasticity.is_static())
          require_equilibrium(scene);
        if (scene.heat)
          of_heat_problem([&] { require_diffusion(*scene.heat); });
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
        const auto [lowest, highest] = poisson_ratios(scene, mesh);
        note_own_poisson_ratio(scene, lowest, highest, notes);
        note_locking(scene, highest, notes);
        note_tips_in_cells(scene, notes);
        note_slender_cracks(scene, notes);
        note_loaded_holes(scene, notes);
        note_slow_oblique_cracks(scene, notes);
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
